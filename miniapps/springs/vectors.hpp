#pragma once

#include <span>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// The coordinates of all vectors, one after the other, as files hold them.
inline std::span<const double> numbers(const std::vector<fabric::Vector>& vectors) {
  return {vectors.data()->data(), 3 * vectors.size()};
}

inline std::span<double> numbers(std::vector<fabric::Vector>& vectors) {
  return {vectors.data()->data(), 3 * vectors.size()};
}

}  // namespace drogue::springs_app
