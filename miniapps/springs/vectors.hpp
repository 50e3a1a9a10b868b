#pragma once

#include <span>
#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::springs_app {

/// Coordinates of all vectors as a flat array (3 n), as files store them.
inline std::span<const double> numbers(const std::vector<fabric::Vector>& vectors) {
  return {vectors.data()->data(), 3 * vectors.size()};
}

inline std::span<double> numbers(std::vector<fabric::Vector>& vectors) {
  return {vectors.data()->data(), 3 * vectors.size()};
}

}  // namespace drogue::springs_app
