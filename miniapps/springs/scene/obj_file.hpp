#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// Mesh of a file, with the line number of each of its parts.
struct ObjContents {
  fabric::Mesh mesh;
  std::vector<int> vertex_line, triangle_line, line_line;
};

/// Name of vertex or face k in errors. k counts from 0, the number in the file from 1. Does not throw.
std::string part_of_file(const std::string& kind, std::size_t k);

/// Reads Wavefront OBJ: `v x y z`, `f` with three vertices (texture and normal indices are ignored), `l`
/// with two or more. Skips names, groups, materials, normals and texture coordinates. `name` replaces the
/// file name in errors. Throws Failure(invalid_scene), `FILE:LINE: ...`, for any other content.
ObjContents parse_obj(std::string_view text, const std::string& name);

/// Checks that the mesh is a surface with lines. Throws Failure(invalid_scene), `FILE:LINE: ...`, with the
/// number of the vertex or face in the file, for duplicated or unused vertices, degenerate or repeated
/// triangles, edges of three triangles, and repeated lines.
void check_obj(const ObjContents& contents, const std::string& name);

/// Reads and checks a file. Throws Failure(invalid_scene), also for an unreadable file.
fabric::Mesh read_obj(const std::filesystem::path& file);

}  // namespace drogue::springs_app
