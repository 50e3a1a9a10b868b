#include "kernels/fabric/elastic/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "kernels/fabric/elastic/membrane.hpp"
#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

namespace {

double squared_distance(const Mesh& mesh, int from, int to) {
  const spatial::Vector3<double> between = edge_vector(mesh, from, to);
  return dot(between, between);
}

/// Chains the triangles of a vertex, each given by its other two vertices, to sequences of neighbours. A
/// closed ring repeats its first neighbour at the end; open ones begin where no triangle ends.
std::vector<std::vector<int>> rings_of(std::vector<std::array<int, 2>> triangles) {
  std::vector<std::vector<int>> rings;
  const auto extract = [&](const auto& fits) -> std::optional<std::array<int, 2>> {
    const auto found = std::ranges::find_if(triangles, fits);
    if (found == triangles.end()) return std::nullopt;
    const std::array<int, 2> triangle = *found;
    triangles.erase(found);
    return triangle;
  };
  const auto begins = [&](const std::array<int, 2>& triangle) {
    return std::ranges::none_of(triangles, [&](const auto& other) { return other[1] == triangle[0]; });
  };
  while (!triangles.empty()) {
    auto triangle = extract(begins);
    if (!triangle) triangle = extract([](const auto&) { return true; });
    std::vector<int>& ring = rings.emplace_back(std::vector<int>{(*triangle)[0]});
    for (; triangle; triangle = extract([&](const auto& next) { return next[0] == ring.back(); }))
      ring.push_back((*triangle)[1]);
  }
  return rings;
}

}  // namespace

RingAdjacency ring_adjacency(const Mesh& mesh) {
  const std::size_t n = mesh.rest.size();
  std::vector<std::vector<std::array<int, 2>>> around(n);  // the other two vertices of every triangle
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      around[static_cast<std::size_t>(t[k])].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
  std::vector<std::vector<EllEntry<3>>> of_vertex(n);
  for (std::size_t i = 0; i < n; ++i)
    for (const std::vector<int>& ring : rings_of(around[i])) {
      auto& entries = of_vertex[i];
      const auto own = static_cast<int>(i);
      if (!entries.empty()) entries.push_back({own, {}});
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const spatial::Vector3<double> next = edge_vector(mesh, own, ring[k]);
        entries.push_back({ring[k], {dot(next, next)}});
        if (k == 0) continue;
        const spatial::Vector3<double> before = edge_vector(mesh, own, ring[k - 1]);
        const GramMatrix<double> rest{dot(before, before), dot(before, next), dot(next, next)};
        entries.back().value = {rest.kk, rest.jk, inverse_area(rest)};
      }
    }
  return sliced(of_vertex);
}

DashpotAdjacency dashpot_adjacency(const Mesh& mesh, const std::vector<double>& mass, double rate) {
  std::vector<std::vector<EllEntry<1>>> of_vertex(mesh.rest.size());
  for (const auto& [i, j] : edges_of(mesh)) {
    const double a = mass[static_cast<std::size_t>(i)], b = mass[static_cast<std::size_t>(j)];
    const double dashpot = rate * (a * b / (a + b));
    of_vertex[static_cast<std::size_t>(i)].push_back({j, {dashpot}});
    of_vertex[static_cast<std::size_t>(j)].push_back({i, {dashpot}});
  }
  return sliced(of_vertex);
}

SpringAdjacency spring_adjacency(const Mesh& mesh, const Material& material) {
  std::vector<std::vector<EllEntry<2>>> of_vertex(mesh.rest.size());
  const auto add = [&](int i, int j, double stiffness, double length) {
    of_vertex[static_cast<std::size_t>(i)].push_back({j, {stiffness, length}});
    of_vertex[static_cast<std::size_t>(j)].push_back({i, {stiffness, length}});
  };
  const auto rest_length = [&](int i, int j) { return std::sqrt(squared_distance(mesh, i, j)); };
  if (material.model == Model::edge || material.model == Model::linear_vector) {
    const bool of_vectors = material.model == Model::linear_vector;
    for (const auto& [i, j] : triangle_edges(mesh))
      add(i, j, material.stiffness, of_vectors ? 0.0 : rest_length(i, j));
  }
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto [i, j] = mesh.lines[k];
    const double length = mesh::rest_length(mesh, k);
    add(i, j, (mesh.line_stiffness.empty() ? material.axial_stiffness : mesh.line_stiffness[k]) / length,
        length);
  }
  return sliced(of_vertex);
}

BendingAdjacency bending_adjacency(const Mesh& mesh, double stiffness) {
  const auto position = [&](int i) -> const Vector& { return mesh.rest[static_cast<std::size_t>(i)]; };
  std::map<mesh::Edge, std::vector<int>> opposite;  // vertices across an edge
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) opposite[mesh::opposite_edge(t, k)].push_back(t[k]);
  std::vector<std::map<int, double>> weights(mesh.rest.size());
  const auto add_hinge = [&](const mesh::Edge& edge, const std::array<int, 2>& across) {
    const std::array<int, 4> vertex = {edge[0], edge[1], across[0], across[1]};
    const double squared = squared_distance(mesh, edge[0], edge[1]);
    double k[4] = {}, areas = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
      const int top = across[side];
      const double to_0 = squared_distance(mesh, edge[0], top), to_1 = squared_distance(mesh, edge[1], top),
                   four_areas = 4.0 / inverse_area(edge_vector(mesh, edge[0], edge[1]),
                                                   edge_vector(mesh, edge[0], top));
      const double at_0 = (squared + to_0 - to_1) / four_areas, at_1 = (squared + to_1 - to_0) / four_areas;
      k[0] += at_1, k[1] += at_0, k[2 + side] -= at_0 + at_1;
      areas += 0.25 * four_areas;
    }
    double bent = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      for (std::size_t a = 0; a < 4; ++a) sum += k[a] * position(vertex[a])[axis];
      bent += sum * sum;
    }
    if (bent > 1e-12 * squared)
      throw std::invalid_argument("fabric solver: fabric that resists bending must be flat at rest");
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        if (a != b)
          weights[static_cast<std::size_t>(vertex[a])][vertex[b]] -= stiffness / areas * k[a] * k[b];
  };
  for (const auto& [edge, across] : opposite)
    for (std::size_t k = 0; k + 1 < across.size(); ++k) add_hinge(edge, {across[k], across[k + 1]});
  std::vector<std::vector<EllEntry<1>>> of_vertex(mesh.rest.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (const auto& [j, weight] : weights[i]) of_vertex[i].push_back({j, {weight}});
  return sliced(of_vertex);
}

std::vector<Vector> rest_forces(const Mesh& mesh, const Material& material) {
  if (material.model != Model::linear_vector) return {};
  std::vector<Vector> forces(mesh.rest.size(), Vector{});
  for (const auto& edge : triangle_edges(mesh)) {
    const auto i = static_cast<std::size_t>(edge[0]), j = static_cast<std::size_t>(edge[1]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double force = material.stiffness * (mesh.rest[j][axis] - mesh.rest[i][axis]);
      forces[i][axis] -= force;
      forces[j][axis] += force;
    }
  }
  return forces;
}

}  // namespace drogue::fabric
