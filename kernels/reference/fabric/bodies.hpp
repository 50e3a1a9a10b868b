#pragma once

#include <array>

#include "kernels/fabric/body.hpp"

namespace drogue::reference {

/// Signed distance of a point from a disk, sphere or plane, m, in extended precision; not negative for a
/// disk. Throws std::invalid_argument for a level set.
[[nodiscard]] double distance_from(const fabric::Body& body, const std::array<double, 3>& place);

/// Returns whether any point of a triangle, m, lies inside a sphere, on a disk, or behind a plane. Throws
/// std::invalid_argument for a level set.
[[nodiscard]] bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 3>& triangle);

/// Returns whether any point of a segment does, as above.
[[nodiscard]] bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 2>& segment);

}  // namespace drogue::reference
