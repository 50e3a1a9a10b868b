#pragma once

#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Partition of points (m) by recursive coordinate bisection (Berger and Bokhari 1987) across the longest
/// extent. Returns the indices of each of `count` parts in ascending order; sizes differ by at most one.
/// Throws std::invalid_argument unless 1 <= count <= max(1, number of points).
[[nodiscard]] std::vector<std::vector<int>> partition_by_recursive_bisection(
    const std::vector<Vector>& points, int count);

}  // namespace drogue::mesh
