#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace drogue::fabric {

/// Leaves a symmetric matrix times `in` in `out`.
using LinearOperator = std::function<void(std::span<const double> in, std::span<double> out)>;

/// The largest eigenvalue of a symmetric matrix of `size` rows, from below: the largest Ritz value after
/// `steps` products, from a vector of seeded noise (Lanczos 1950). That vectors lose their orthogonality
/// brings back values already found, and none beyond (Paige 1980).
[[nodiscard]] double largest_ritz_value(std::size_t size, int steps, const LinearOperator& apply);

}  // namespace drogue::fabric
