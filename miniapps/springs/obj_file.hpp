#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// A mesh and the line of the file that gives each of its parts.
struct ObjContents {
  fabric::Mesh mesh;
  std::vector<int> vertex_line, triangle_line, line_line;
};

/// What errors call vertex or face k, k from 0: by its number in the file, which counts from 1.
std::string part_of_file(const std::string& kind, std::size_t k);

/// Reads Wavefront OBJ: `v x y z`, `f` with three vertices (texture and normal numbers are passed over), `l`
/// with two or more; names, groups, materials, normals and texture coordinates mean nothing to cloth and are
/// skipped. `name` stands for the file in errors. Throws Failure(invalid_scene), `FILE:LINE: ...`, for all
/// else.
ObjContents parse_obj(std::string_view text, const std::string& name);

/// Refuses what no cloth can be made of: duplicated and orphan vertices, degenerate and repeated triangles,
/// edges of three triangles, repeated lines. Throws Failure(invalid_scene), `FILE:LINE: ...`, with the number
/// of the vertex or face, counted from 1 as in the file.
void check_obj(const ObjContents& contents, const std::string& name);

/// Reads and checks a file. Throws Failure(invalid_scene), also where it cannot be read.
fabric::Mesh read_obj(const std::filesystem::path& file);

}  // namespace drogue::springs_app
