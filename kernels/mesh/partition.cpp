#include "kernels/mesh/partition.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

namespace drogue::mesh {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Axis of the largest extent of some points.
std::size_t longest_axis(const std::vector<Vector>& points, std::span<const int> vertices) {
  std::size_t longest = 0;
  double largest = -1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(vertices, {}, [&](int i) { return points[index(i)][axis]; });
    const double extent = points[index(high)][axis] - points[index(low)][axis];
    if (extent > largest) largest = extent, longest = axis;
  }
  return longest;
}

/// Bisection of a point set. Part k of `count` starts at entry k n / count, so sizes differ by at most one.
class Bisection {
 public:
  Bisection(const std::vector<Vector>& points, int count)
      : _points(points), _count(index(count)), _vertices(points.size()), _parts(index(count)) {
    std::iota(_vertices.begin(), _vertices.end(), 0);
    halve(0, _count);
  }
  [[nodiscard]] const std::vector<std::vector<int>>& parts() const { return _parts; }

 private:
  [[nodiscard]] auto begin_of(std::size_t part) {
    return _vertices.begin() + static_cast<std::ptrdiff_t>(part * _points.size() / _count);
  }

  void halve(std::size_t first, std::size_t last) {
    const auto begin = begin_of(first), end = begin_of(last);
    if (last - first == 1) {
      // In mesh order, so that the data of a part is contiguous.
      std::sort(begin, end);
      _parts[first].assign(begin, end);
      return;
    }
    const std::size_t middle = (first + last) / 2, axis = longest_axis(_points, {begin, end});
    const auto before = [&](int i, int j) {
      return std::pair(_points[index(i)][axis], i) < std::pair(_points[index(j)][axis], j);
    };
    std::nth_element(begin, begin_of(middle), end, before);
    halve(first, middle);
    halve(middle, last);
  }

  const std::vector<Vector>& _points;
  std::size_t _count;
  std::vector<int> _vertices;
  std::vector<std::vector<int>> _parts;
};

}  // namespace

std::vector<std::vector<int>> partition_by_recursive_bisection(const std::vector<Vector>& points, int count) {
  if (count < 1 || index(count) > std::max<std::size_t>(points.size(), 1))
    throw std::invalid_argument("mesh partition: the number of parts must be 1 to the number of points");
  return Bisection(points, count).parts();
}

}  // namespace drogue::mesh
