#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::parachute_app {

/// Elastic rectangle whose leading edge is hinged along z; a strip that spans the domain in two dimensions.
struct Flag {
  std::array<double, 2> leading_edge{};  ///< x and y, m
  double length = 0.0;                   ///< m
  double angle = 0.0;                    ///< degrees, from x towards y, of the straight strip at the start
  double area_density = 0.0;             ///< kg/m^2
  double bending_stiffness = 0.0;        ///< N m
  double membrane_modulus = 1000.0;      ///< N/m
  double edge_length = 0.0;              ///< m, largest edge along and across the flag
  std::optional<double> width;           ///< m along z; none: it spans a domain of one cell along z
  double middle = 0.0;                   ///< of the width, z, m
  std::array<double, 2> span{};          ///< ends of that domain along z, m; no key

  /// True if the flag ends within the domain along z. Does not throw.
  [[nodiscard]] bool has_width() const { return width.has_value(); }
  /// Number of edges along the flag. Real, since it may exceed any integer. Does not throw.
  [[nodiscard]] double divisions() const;
  /// Number of edges across the flag: 1 if it spans the domain, else even. Real likewise. Does not throw.
  [[nodiscard]] double divisions_across() const;
  /// Number of vertices. Real likewise. Does not throw.
  [[nodiscard]] double vertices() const { return (divisions() + 1.0) * (divisions_across() + 1.0); }
};

/// Vertices of a flag in the vectors of the solver: lines across it from the leading edge to the trailing
/// one.
struct FlagRows {
  std::size_t begin = 0, end = 0;
  std::array<std::size_t, 2> tip{};  ///< vertices in whose middle the tip lies; twice the same, or two
};

/// Appends flags, straight along x at rest, and their positions at the start, m. All have the bending
/// stiffness and the membrane modulus of the first. Throws only std::bad_alloc.
std::vector<FlagRows> append_flags(const std::vector<Flag>& flags, fabric::Parameters& sheets,
                                   std::vector<fabric::Vector>& positions);

}  // namespace drogue::parachute_app
