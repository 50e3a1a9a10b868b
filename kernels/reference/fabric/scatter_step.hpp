#pragma once

#include <array>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::reference {

/// Baseline of the performance comparison: serial steps of biquadratic springs ([Shi], section 4.5). A loop
/// over the triangles adds the forces of stored tensile and angular stiffnesses (Delingette 2008,
/// section 3.2, with twice the shear modulus for mu) to the vertices. The classical Runge-Kutta method stores
/// four slopes.
class ScatterSheet {
 public:
  /// Uses the triangles, gravity, absolute damping and pins of `p`; ignores all else.
  explicit ScatterSheet(const fabric::Parameters& p);

  /// Advances positions x, m, and velocities v, m/s, of all vertices by one step of dt, s, in place.
  void step(double dt, std::vector<fabric::Vector>& x, std::vector<fabric::Vector>& v);

  /// Elastic forces f, N, at positions x, m.
  void forces(const std::vector<fabric::Vector>& x, std::vector<fabric::Vector>& f) const;

 private:
  struct Springs {
    std::array<std::size_t, 3> vertex;
    std::array<double, 3> rest;     ///< squared lengths of the edges opposite the vertices, m^2
    std::array<double, 3> tensile;  ///< N/m^3
    std::array<double, 3> angular;  ///< between the other two edges, N/m^3
  };

  void slopes(const std::vector<fabric::Vector>& x, const std::vector<fabric::Vector>& v,
              std::vector<fabric::Vector>& a);

  std::vector<Springs> _triangles;
  std::vector<double> _mass;
  std::vector<std::uint8_t> _pinned;
  fabric::Vector _gravity;
  double _damping;
  std::array<std::vector<fabric::Vector>, 4> _a, _v;
  std::vector<fabric::Vector> _at;
};

}  // namespace drogue::reference
