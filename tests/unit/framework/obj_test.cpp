#include <gtest/gtest.h>

#include "miniapps/framework/obj_file.hpp"
#include "tests/support/refusal.hpp"

namespace drogue::framework {
namespace {

/// A square of two triangles, and a string of two pieces that hangs from a corner.
const std::string square =
    "# comment\nmtllib x.mtl\no sheet\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n"
    "s off\nf 1 2 3\nf 1//1 3//1 4//1\nv 0 1 -1\nv 0 1 -2\nl 4 5 -1\n";

ObjContents read_mesh(const std::string& text) {
  ObjContents contents = parse_obj(text, "m.obj");
  check_obj(contents, "m.obj");
  return contents;
}

std::string mesh_error(const std::string& text) {
  return testing::refusal_of([&] { return read_mesh(text); });
}

TEST(ObjFile, ReadsVerticesFacesAndLines) {
  const ObjContents contents = read_mesh(square);
  EXPECT_EQ(contents.mesh.rest.size(), 6U);
  EXPECT_EQ(contents.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(contents.mesh.lines, (std::vector<std::array<int, 2>>{{3, 4}, {4, 5}}));
  EXPECT_EQ(contents.vertex_line, (std::vector<int>{4, 5, 6, 7, 12, 13}));
  EXPECT_EQ(contents.triangle_line, (std::vector<int>{10, 11}));
}

TEST(ObjFile, ReadsCrLfAndAllNumberFormats) {
  const ObjContents contents = read_mesh("v +0.5 -1e-3 .25\r\nv 1 0 0\r\nv 0 2 0\r\nf -3 -2 -1");
  EXPECT_EQ(contents.mesh.rest[0], (mesh::Vector{0.5, -1e-3, 0.25}));
  EXPECT_EQ(contents.mesh.triangles[0], (std::array{0, 1, 2}));
}

TEST(ObjFile, ReadsCrAsTheEndOfALine) {
  const ObjContents contents = read_mesh("v 0 0 0\rv 1 0 0\r\rv 0 2 0\rf 1 2 3\r");
  EXPECT_EQ(contents.mesh.rest.size(), 3U);
  EXPECT_EQ(contents.vertex_line, (std::vector<int>{1, 2, 4}));
  EXPECT_EQ(contents.triangle_line, std::vector<int>{5});
  EXPECT_TRUE(mesh_error("v 0 0 0\rv 1 0\r").starts_with("m.obj:2: ")) << "lines count";
}

TEST(ObjFile, AcceptsUnitWeightsAndColours) {
  const ObjContents contents = read_mesh("v 1 0 0 1.0\nv 0 1 0 0.5 0.25 1\nv 0 0 1\nf 1 2 3\n");
  EXPECT_EQ(contents.mesh.rest, (std::vector<mesh::Vector>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(ObjFile, ErrorsNameFileLineAndPart) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::vector<std::array<std::string, 3>> cases = {
      {"", "m.obj:1: ", "no vertex"},
      {"v 0 0\n", "m.obj:1: ", "vertex 1 of the file has 2 numbers"},
      {"v 0 0 0 0 0\n", "m.obj:1: ", "vertex 1 of the file has 5 numbers"},
      {"v 0 0 0 0.5\n", "m.obj:1: ", "vertex 1 of the file has the weight 0.5"},
      {"v 0 0 0 1 1 red\n", "m.obj:1: ", "\"red\" is not a finite number"},
      {"v 0 0 zero\n", "m.obj:1: ", "\"zero\" is not a finite number"},
      {"v 0 0 nan\n", "m.obj:1: ", "not a finite number"},
      {three + "f 1 2\n", "m.obj:4: ", "face 1 of the file has 2 vertices"},
      {three + "v 1 1 0\nf 1 4 2 3\n", "m.obj:5: ", "face 1 of the file has no area or crosses itself"},
      {three + "v 1 1 0\nf 1 2 4 1\n", "m.obj:5: ", "face 1 of the file names vertex 1 twice"},
      {three + "f 1 \\\n 2 \\\n 9\n", "m.obj:4: ", "face 1 of the file names vertex 9"},
      {three + "f 1 \\\n 2 3\nx\n", "m.obj:6: ", "unknown statement"},
      {three + "p 1 2\nv 7 7 7\nf 1 2 3\np 4\n", "m.obj:5: ", "vertex 4 of the file belongs to no face"},
      {"\xFF\xFEv 0 0", "m.obj:1: ", "UTF-16"},
      {three + "f 1 2 0\n", "m.obj:4: ", "vertex 0"},
      {three + "f 1 2 4\n", "m.obj:4: ", "face 1 of the file names vertex 4; the file has 3"},
      {three + "f 1 2 -4\n", "m.obj:4: ", "vertex -4"},
      {three + "f 1 2 2\n", "m.obj:4: ", "face 1 of the file names vertex 2 twice"},
      {three + "f 1 2 3x\n", "m.obj:4: ", "\"3x\""},
      {three + "f 1 2 99999999999999999999\n", "m.obj:4: ", "not the number of a vertex"},
      {three + "l 1\n", "m.obj:4: ", "two vertices"},
      {three + "l 1 1\n", "m.obj:4: ", "from vertex 1 of the file to itself"},
      {three + "f 1 2 3\nl 1 7\n", "m.obj:5: ", "names vertex 7"},
      {three + "fa 1 2 3\n",
       "m.obj:4: ", "unknown statement \"fa\"; valid are v, f, l, and without effect p, vn,"},
      {three + "v 0 0 0\nf 1 2 3\nl 1 4\n", "m.obj:4: ", "vertex 4 of the file lies where vertex 1 does"},
      {three + "v 5 5 5\nf 1 2 3\n", "m.obj:4: ", "vertex 4 of the file belongs to no face"},
      {three + "v 2 0 0\nf 1 2 3\nf 1 2 4\n",
       "m.obj:6: ", "face 2 of the file (vertices 1, 2, 4) has no area"},
      {three + "v 0 0 1\nv 0 0 -1\nf 1 2 3\nf 1 2 4\nf 2 1 5\n",
       "m.obj:8: ", "face 3 of the file is the third at the edge of vertices 1 and 2"},
      {three + "f 1 2 3\nf 3 1 2\n", "m.obj:5: ", "face 2 of the file repeats face 1"},
      {three + "v 1 1 0\nf 1 2 4 3\nf 1 2 4\n", "m.obj:6: ", "face 2 of the file repeats face 1"},
      {three + "f 1 2 3\nl 1 2\nl 2 1\n",
       "m.obj:6: ", "from vertex 1 of the file to 2 is given twice, first in line 5"},
  };
  for (const auto& [text, start, words] : cases) {
    const std::string message = mesh_error(text);
    EXPECT_TRUE(message.starts_with(start)) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
}

TEST(ObjFile, DividesPolygonsAndNamesTheirFaces) {
  const ObjContents contents = read_mesh(
      "\xEF\xBB\xBF# C:\\meshes\\\nv 0 0 0\nv 1 0 0\nf 1 2 3 4\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
      "p 1\nf 2/1/1 5/2/1 \\\r\n6/3/1 \\\n3/4/1\n");
  EXPECT_EQ(contents.mesh.triangles,
            (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
  EXPECT_EQ(contents.triangle_line, (std::vector<int>{4, 4, 10, 10}));
  EXPECT_EQ(contents.face_of, (std::vector<std::size_t>{0, 0, 1, 1}));
}

TEST(ObjFile, AcceptsALineAlongATriangleEdge) { EXPECT_EQ(mesh_error(square + "l 1 2\n"), ""); }

}  // namespace
}  // namespace drogue::framework
