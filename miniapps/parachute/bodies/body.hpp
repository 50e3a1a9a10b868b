#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"

namespace drogue::parachute_app {

/// Kinds of bodies.
enum class BodyKind {
  plate,  ///< rectangle normal to an axis
};

/// Laws of the flow through a sheet.
enum class PorosityLaw {
  none,         ///< impermeable
  forchheimer,  ///< pressure difference alpha w + beta |w| w at the normal velocity w
};

struct Porosity {
  PorosityLaw law = PorosityLaw::none;
  // Measured on cloth MIL-C-7020 type III.
  double alpha = 254.4;  ///< Pa s/m
  double beta = 37.6;    ///< Pa s^2/m^2
};

/// Sheet that does not move, immersed in the flow.
struct Body {
  BodyKind kind = BodyKind::plate;
  int normal = 0;                   ///< axis
  std::array<double, 3> centre{};   ///< m
  std::array<double, 2> lengths{};  ///< m, along the other axes in ascending order
  double edge_length = 0.0;         ///< m, of the triangles
  Porosity porosity;

  /// The two axes along the plate, ascending. Does not throw.
  [[nodiscard]] std::array<std::size_t, 2> axes() const;

  /// Numbers of edges along these axes, and of vertices. Do not throw.
  [[nodiscard]] std::array<int, 2> edges() const;
  [[nodiscard]] std::size_t vertices() const {
    return static_cast<std::size_t>(edges()[0] + 1) * static_cast<std::size_t>(edges()[1] + 1);
  }
};

/// Largest distance of vertices in cells at which a sheet does not leak: 1 / 1.4. Shown by
/// `FixedSheet.FollowsThePorousLawAtAnySlope` at half a cell.
inline constexpr double largest_edge_in_cells = 1.0 / 1.4;

/// Number of vertices of all bodies. Does not throw.
[[nodiscard]] std::size_t vertices_of(const std::vector<Body>& bodies);

/// The bodies as one pinned cloth. Throws only std::bad_alloc.
[[nodiscard]] fabric::Parameters make_sheets(const std::vector<Body>& bodies);

/// Law of the sheet for the solver. Does not throw.
[[nodiscard]] coupling::PorousLaw law_of(const Porosity& porosity);

}  // namespace drogue::parachute_app
