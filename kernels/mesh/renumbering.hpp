#pragma once

#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Vertex order of small bandwidth by Cuthill and McKee (1969), reversed. Entry k is the present index of the
/// vertex that becomes vertex k. Throws only std::bad_alloc.
[[nodiscard]] std::vector<int> reverse_cuthill_mckee(const Mesh& mesh);

/// Mesh with its vertices in the given order (a permutation of 0 .. n-1). Triangles and lines keep their own
/// order. Throws only std::bad_alloc.
[[nodiscard]] Mesh renumber(const Mesh& mesh, const std::vector<int>& order);

}  // namespace drogue::mesh
