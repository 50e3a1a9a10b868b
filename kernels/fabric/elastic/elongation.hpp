#pragma once

#include <array>
#include <span>

#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Largest elongation of triangles in any direction at `positions`, m, relative to the length at rest; 0 if
/// they are shorter in all directions. Does not throw.
[[nodiscard]] double largest_elongation(const Mesh& mesh, std::span<const std::array<int, 3>> triangles,
                                        std::span<const Vector> positions);

}  // namespace drogue::fabric
