#pragma once

#include <array>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::reference {

/// The yardstick of speed: biquadratic cloth as the dissertation computes it (section 4.5) and one would
/// write it first. A loop over the triangles adds the forces of their stored tensile and angular stiffnesses
/// (Delingette 2008, section 3.2, with twice the shear modulus for mu) to their vertices; the classical
/// Runge-Kutta method keeps four slopes.
class ScatterSheet {
 public:
  /// Of triangles alone, with gravity, absolute damping and pins.
  explicit ScatterSheet(const fabric::Parameters& p);

  /// Takes a step of dt, s, in place; vectors of all vertices, m and m/s.
  void step(double dt, std::vector<fabric::Vector>& x, std::vector<fabric::Vector>& v);

  /// Elastic forces, N.
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
