#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::parachute_app {

/// Elastic strip in two dimensions whose leading edge is hinged at a fixed point.
struct Flag {
  std::array<double, 2> leading_edge{};  ///< x and y, m
  double length = 0.0;                   ///< m
  double angle = 0.0;                    ///< degrees, from x towards y, of the straight strip at the start
  double area_density = 0.0;             ///< kg/m^2
  double bending_stiffness = 0.0;        ///< N m
  double membrane_modulus = 1000.0;      ///< N/m
  double edge_length = 0.0;              ///< m, largest edge along the strip
  std::array<double, 2> span{};          ///< ends of the domain along z, m, which the strip spans; no key

  /// Number of edges along the strip. Real, since it may exceed any integer. Does not throw.
  [[nodiscard]] double divisions() const;
  /// Two rows. Does not throw.
  [[nodiscard]] double vertices() const { return 2.0 * (divisions() + 1.0); }
};

/// Rows of a flag in the vectors of the solver: pairs of vertices from the leading edge to the tip.
struct FlagRows {
  std::size_t begin = 0, end = 0;
};

/// Appends flags, straight along x at rest, and their positions at the start, m. All have the bending
/// stiffness and the membrane modulus of the first. Throws only std::bad_alloc.
std::vector<FlagRows> append_flags(const std::vector<Flag>& flags, fabric::Parameters& sheets,
                                   std::vector<fabric::Vector>& positions);

}  // namespace drogue::parachute_app
