#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/scene/read.hpp"
#include "kernels/mesh/mesh.hpp"

namespace drogue::framework {

/// Mesh of a file, with the line number of each of its parts.
struct ObjContents {
  mesh::Mesh mesh;
  std::vector<int> vertex_line, triangle_line, line_line;
  std::vector<std::size_t> face_of;  ///< number of the face of each triangle, from 0
};

/// Name of vertex or face k in errors. k counts from 0, the number in the file from 1. Does not throw.
std::string part_of_file(const std::string& kind, std::size_t k);

/// Reads Wavefront OBJ: `v x y z`, `f` with three vertices or more (texture and normal indices are ignored),
/// which `mesh::triangulate` divides, `l` with two or more. Skips points, names, groups, materials, normals
/// and texture coordinates, and a byte-order mark. A backslash at the end of a line continues it. `name`
/// replaces the file name in errors. Throws Failure(invalid_scene), `FILE:LINE: ...`, for any other content.
ObjContents parse_obj(std::string_view text, const std::string& name);

/// Checks that the mesh is a surface with lines. Throws Failure(invalid_scene), `FILE:LINE: ...`, with the
/// number of the vertex or face in the file, for duplicated or unused vertices, degenerate or repeated
/// triangles, edges of three triangles, and repeated lines.
void check_obj(const ObjContents& contents, const std::string& name);

/// Reads and checks the file that the key `file` of a table names, relative to the folder of the scene.
/// Replaces its name by its absolute path, so that the resolved scene is valid in any folder. The mesh is in
/// m; `metres` of the key `scale`: m per unit of length of the file. Adds a
/// sentence to `notices` for vertices nearer than 1e-6 of its extent. Throws Failure(invalid_scene), also for
/// a file that is missing or cannot be read, and for an extent that is not between 1e-60 and 1e60 m.
mesh::Mesh read_obj(const scene::Place& at, double metres, const std::filesystem::path& scene_file,
                    std::string& file, std::vector<std::string>& notices);

/// Coordinates and indices of a mesh as text: of a file, the content counts in a fingerprint, not the path.
std::string contents_of(const mesh::Mesh& mesh);

}  // namespace drogue::framework
