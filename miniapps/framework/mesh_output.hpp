#pragma once

#include <string>

#include "common/run/fields/field_sink.hpp"
#include "kernels/mesh/mesh.hpp"

namespace drogue::framework {

/// Writes triangles, edges, lines and vertices at rest of a mesh to fields.h5, of which the vertices complete
/// fields.xdmf. `strings`: description of the lines, which the dataset `edges` does not distinguish. `grid`:
/// name of the grid in a file with several. Throws `Failure` (io_error).
void write_mesh(run::FieldSink& fields, const mesh::Mesh& mesh, const std::string& strings,
                const std::string& grid = "");

}  // namespace drogue::framework
