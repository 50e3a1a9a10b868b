#pragma once

#include <string>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Text with the numbers of vertices, triangles, lines, parts of the surface and free edges, and the ranges
/// of edge lengths (m), areas (m^2) and angles (degrees), one quantity per line. Throws only std::bad_alloc.
[[nodiscard]] std::string quality_report(const Mesh& mesh);

}  // namespace drogue::mesh
