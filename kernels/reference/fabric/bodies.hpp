#pragma once

#include <array>

#include "kernels/fabric/parameters.hpp"

namespace drogue::reference {

/// Signed distance of a place from a disk, sphere or plane, m; never negative from a disk. By the angle at
/// which the place is seen, in extended precision. std::invalid_argument for a level set.
[[nodiscard]] double distance_from(const fabric::Body& body, const std::array<double, 3>& place);

/// Whether some point of a triangle, not only a corner, lies within a sphere, in a disk, or behind a plane.
[[nodiscard]] bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 3>& triangle);

/// The same of a segment.
[[nodiscard]] bool enters(const fabric::Body& body, const std::array<std::array<double, 3>, 2>& segment);

}  // namespace drogue::reference
