#pragma once

#include <array>
#include <optional>
#include <span>

namespace drogue::reference {

using Place3 = std::array<double, 3>;

/// Distance between the convex hulls of two point sets with four points in total, m, in extended precision.
/// Minimum over all pairs of faces (triangle, edges, corners) of the distance of their affine hulls, where
/// the closest points lie in both faces.
[[nodiscard]] double hull_distance(std::span<const Place3> a, std::span<const Place3> b);

/// First collision time in [0, 1] of the hull of the first `split` of four points with the hull of the
/// others. The points, m, move linearly from `from` to `to`. Roots of the cubic for coplanarity (Provot 1997)
/// at which the distance of the hulls is at most `touching`, m; empty without collision.
[[nodiscard]] std::optional<double> first_meeting(const std::array<Place3, 4>& from,
                                                  const std::array<Place3, 4>& to, std::size_t split,
                                                  double touching);

}  // namespace drogue::reference
