#pragma once

#include <cstddef>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::coupling {

/// Inverse mass of every vertex of a cloth along each axis, 1/kg: zero along axes that are pinned or have a
/// prescribed motion. Throws std::bad_alloc.
[[nodiscard]] inline std::vector<fabric::Vector> inverse_masses(const fabric::Parameters& cloth) {
  std::vector<fabric::Vector> result(cloth.mass.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_pinned = !cloth.pinned.empty() && (cloth.pinned[i] >> axis & 1U) != 0U;
      result[i][axis] = is_pinned ? 0.0 : 1.0 / cloth.mass[i];
    }
  for (const fabric::Motion& motion : cloth.motions)
    for (const int i : motion.vertices)
      result[static_cast<std::size_t>(i)][static_cast<std::size_t>(motion.axis)] = 0.0;
  return result;
}

}  // namespace drogue::coupling
