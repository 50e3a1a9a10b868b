#include "miniapps/parachute/canopy/periodic_images.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/reference/fabric/intersections.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// True if the boxes around points and around their image overlap.
bool may_meet(std::span<const Vector> positions, const Vector& period) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(positions, {}, [axis](const Vector& x) { return x[axis]; });
    if (high[axis] - low[axis] < std::abs(period[axis])) return false;
  }
  return true;
}

/// Parts, then the same of the image, whose vertices follow those of the original.
template <std::size_t n>
std::vector<std::array<int, n>> doubled(std::span<const std::array<int, n>> parts, int vertices) {
  std::vector<std::array<int, n>> result(parts.begin(), parts.end());
  for (std::array<int, n> part : parts) {
    for (int& i : part) i += vertices;
    result.push_back(part);
  }
  return result;
}

}  // namespace

std::vector<Vector> periods_of(const flow::Parameters& p) {
  Vector width{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (p.cells[axis] > 1 && p.boundary[2 * axis].kind == flow::BoundaryKind::periodic)
      width[axis] = p.high[axis] - p.low[axis];
  std::vector<Vector> periods;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        const std::array<int, 3> steps = {i, j, k};
        const bool is_first_of_pair = steps > std::array<int, 3>{0, 0, 0};
        Vector period{};
        bool repeats = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          repeats = repeats && (steps[axis] == 0 || width[axis] > 0.0);
          period[axis] = steps[axis] * width[axis];
        }
        if (is_first_of_pair && repeats) periods.push_back(period);
      }
  return periods;
}

std::vector<ImageIntersection> image_intersections(std::span<const Vector> positions,
                                                   std::span<const std::array<int, 3>> triangles,
                                                   std::span<const std::array<int, 2>> lines,
                                                   std::span<const Vector> periods, int bodies_end) {
  std::vector<ImageIntersection> found;
  const auto n = static_cast<int>(positions.size());
  for (const Vector& period : periods) {
    if (!may_meet(positions, period)) continue;
    std::vector<Vector> both(positions.begin(), positions.end());
    for (const Vector& x : positions) both.push_back({x[0] + period[0], x[1] + period[1], x[2] + period[2]});
    const auto faces = doubled(triangles, n);
    for (const auto& [segment, number] : reference::intersections(both, faces, doubled(lines, n))) {
      const int one = segment[0], other = faces[number][0];
      if ((one < n) == (other < n)) continue;  // both belong to one copy
      if (one % n >= bodies_end || other % n >= bodies_end) found.push_back({one % n, other % n});
    }
  }
  return found;
}

}  // namespace drogue::parachute_app
