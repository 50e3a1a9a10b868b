#include "common/program/failure.hpp"
#include "kernels/mesh/topology.hpp"
#include "miniapps/framework/obj_file.hpp"

namespace drogue::framework {
namespace {

std::string one_based(int i) { return std::to_string(i + 1); }

/// Name of the face of triangle k.
std::string face_text(const ObjContents& contents, std::size_t k) {
  return part_of_file("face", contents.face_of[k]);
}

std::string repeated_face(const ObjContents& contents, const mesh::Defect& defect) {
  return "face " + std::to_string(contents.face_of[static_cast<std::size_t>(defect.other)] + 1);
}

/// Line of the file and sentence that describe a defect.
std::pair<int, std::string> describe(const mesh::Defect& defect, const ObjContents& contents) {
  using mesh::DefectKind;
  const std::size_t k = defect.part;
  const std::string other = one_based(defect.other);
  switch (defect.kind) {
    case DefectKind::duplicate_vertex:
      return {contents.vertex_line[k], part_of_file("vertex", k) + " lies where vertex " + other +
                                           " does; name one vertex in both places"};
    case DefectKind::orphan_vertex:
      return {contents.vertex_line[k],
              part_of_file("vertex", k) + " belongs to no face and no line: it would have no mass"};
    case DefectKind::degenerate_triangle: {
      const auto& triangle = contents.mesh.triangles[k];
      return {contents.triangle_line[k], face_text(contents, k) + " (vertices " + one_based(triangle[0]) +
                                             ", " + one_based(triangle[1]) + ", " + one_based(triangle[2]) +
                                             ") has no area"};
    }
    case DefectKind::duplicate_triangle:
      return {contents.triangle_line[k],
              face_text(contents, k) + " repeats " + repeated_face(contents, defect)};
    case DefectKind::non_manifold_edge:
      return {contents.triangle_line[k], face_text(contents, k) + " is the third at the edge of vertices " +
                                             one_based(defect.vertices[0]) + " and " +
                                             one_based(defect.vertices[1]) + ": cloth must be a manifold"};
    case DefectKind::duplicate_line:
      break;
  }
  return {contents.line_line[k],
          "the line from " + part_of_file("vertex", static_cast<std::size_t>(defect.vertices[0])) + " to " +
              one_based(defect.vertices[1]) + " is given twice, first in line " +
              std::to_string(contents.line_line[static_cast<std::size_t>(defect.other)])};
}

}  // namespace

void check_obj(const ObjContents& contents, const std::string& name) {
  const std::optional<mesh::Defect> defect = mesh::find_defect(contents.mesh);
  if (!defect) return;
  const auto [line, sentence] = describe(*defect, contents);
  throw Failure(ExitCode::invalid_scene, name + ":" + std::to_string(line) + ": " + sentence);
}

}  // namespace drogue::framework
