#pragma once

#include <array>
#include <optional>
#include <span>

namespace drogue::reference {

using Place3 = std::array<double, 3>;

/// Least distance between the convex hulls of two and two places, or of one and three, m, in extended
/// precision: of all pairs of a face of one (itself, its edges and corners) and a face of the other, between
/// the planes, lines and points that carry them, where the nearest points are in both.
[[nodiscard]] double hull_distance(std::span<const Place3> a, std::span<const Place3> b);

/// The share of the way at which places that move straight from `from` to `to` first meet: the first
/// `split` of four as the hull of their own, and the others as that of theirs. The roots of the cubic that
/// says when all four lie in a plane (Provot 1997), at which the hulls have a distance below `touching`, m.
[[nodiscard]] std::optional<double> first_meeting(const std::array<Place3, 4>& from,
                                                  const std::array<Place3, 4>& to, std::size_t split,
                                                  double touching);

}  // namespace drogue::reference
