#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/program/failure.hpp"
#include "common/scene/node.hpp"
#include "kernels/fabric/edges.hpp"
#include "miniapps/springs/mesh_topology.hpp"
#include "miniapps/springs/obj_file.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Mesh;
using fabric::Vector;

/// Height over longest edge below which a triangle counts as one without area: that of rounded coordinates.
constexpr double flat = 1e-12;

class ObjChecker {
 public:
  ObjChecker(const ObjContents& contents, const std::string& name)
      : _contents(contents), _mesh(contents.mesh), _name(name) {}

  void run() const {
    duplicated_vertices();
    orphans();
    degenerate_triangles();
    edges();
    repeated_lines();
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& sentence) const {
    throw Failure(ExitCode::invalid_scene, _name + ":" + std::to_string(line) + ": " + sentence);
  }

  static std::string one_based(int i) { return std::to_string(i + 1); }

  static std::string part(const char* kind, int i) { return part_of_file(kind, static_cast<std::size_t>(i)); }

  /// The first entry that equals one before it, and that one; equal parts of a file mean a slip.
  template <class T>
  static std::pair<int, int> first_repeated(const std::vector<T>& values) {
    std::vector<int> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    const auto value = [&](int i) -> const T& { return values[static_cast<std::size_t>(i)]; };
    std::ranges::sort(order,
                      [&](int i, int j) { return value(i) != value(j) ? value(i) < value(j) : i < j; });
    std::pair<int, int> first{static_cast<int>(values.size()), -1};
    for (std::size_t k = 1; k < order.size(); ++k)
      if (value(order[k]) == value(order[k - 1]) && order[k] < first.first) first = {order[k], order[k - 1]};
    return first;
  }

  void duplicated_vertices() const {
    const auto [second, first] = first_repeated(_mesh.rest);
    if (first < 0) return;
    refuse(_contents.vertex_line[static_cast<std::size_t>(second)],
           part("vertex", second) + " lies where vertex " + one_based(first) +
               " does; name one vertex in both places");
  }

  void orphans() const {
    std::vector<char> used(_mesh.rest.size(), 0);
    for (const auto& triangle : _mesh.triangles)
      for (const int i : triangle) used[static_cast<std::size_t>(i)] = 1;
    for (const auto& line : _mesh.lines)
      for (const int i : line) used[static_cast<std::size_t>(i)] = 1;
    const auto orphan = std::ranges::find(used, 0);
    if (orphan == used.end()) return;
    const auto i = static_cast<std::size_t>(orphan - used.begin());
    refuse(_contents.vertex_line[i],
           part_of_file("vertex", i) + " belongs to no face and no line: it would have no mass");
  }

  void degenerate_triangles() const {
    for (std::size_t k = 0; k < _mesh.triangles.size(); ++k) {
      const Vector normal = double_area(_mesh.rest, _mesh.triangles[k]);
      double longest = 0.0;
      for (std::size_t e = 0; e < 3; ++e)
        longest = std::max(
            longest, fabric::rest_distance(_mesh, _mesh.triangles[k][e], _mesh.triangles[k][(e + 1) % 3]));
      const double twice = std::hypot(normal[0], normal[1], normal[2]);
      if (!(twice > flat * longest * longest) || !std::isfinite(longest))
        refuse(_contents.triangle_line[k], part_of_file("face", k) + " (vertices " +
                                               one_based(_mesh.triangles[k][0]) + ", " +
                                               one_based(_mesh.triangles[k][1]) + ", " +
                                               one_based(_mesh.triangles[k][2]) + ") has no area");
    }
  }

  void edges() const {
    std::vector<std::array<int, 3>> sorted = _mesh.triangles;
    for (auto& triangle : sorted) std::ranges::sort(triangle);
    if (const auto [second, first] = first_repeated(sorted); first >= 0)
      refuse(_contents.triangle_line[static_cast<std::size_t>(second)],
             part("face", second) + " repeats face " + one_based(first));
    // Edge and the triangle it is of.
    std::vector<std::array<int, 3>> edges;
    for (std::size_t k = 0; k < sorted.size(); ++k)
      for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}})
        edges.push_back({sorted[k][a], sorted[k][b], static_cast<int>(k)});
    std::ranges::sort(edges);
    std::array<int, 3> worst{0, 0, static_cast<int>(sorted.size())};
    for (std::size_t k = 2; k < edges.size(); ++k)
      if (edges[k][0] == edges[k - 2][0] && edges[k][1] == edges[k - 2][1] && edges[k][2] < worst[2])
        worst = edges[k];
    if (worst[2] == static_cast<int>(sorted.size())) return;
    refuse(_contents.triangle_line[static_cast<std::size_t>(worst[2])],
           part("face", worst[2]) + " is the third at the edge of vertices " + one_based(worst[0]) + " and " +
               one_based(worst[1]) + ": cloth must be a manifold");
  }

  void repeated_lines() const {
    std::vector<std::array<int, 2>> sorted = _mesh.lines;
    for (auto& line : sorted) std::ranges::sort(line);
    const auto [second, first] = first_repeated(sorted);
    if (first < 0) return;
    const auto& [a, b] = sorted[static_cast<std::size_t>(second)];
    refuse(_contents.line_line[static_cast<std::size_t>(second)],
           "the line from " + part("vertex", a) + " to " + one_based(b) + " is given twice, first in line " +
               std::to_string(_contents.line_line[static_cast<std::size_t>(first)]));
  }

  const ObjContents& _contents;
  const Mesh& _mesh;
  const std::string& _name;
};

}  // namespace

void check_obj(const ObjContents& contents, const std::string& name) { ObjChecker(contents, name).run(); }

}  // namespace drogue::springs_app
