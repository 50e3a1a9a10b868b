#include "kernels/mesh/renumbering.hpp"

#include <algorithm>

#include "kernels/mesh/edges.hpp"

namespace drogue::mesh {
namespace {

/// Neighbours of every vertex in ascending order: entries first[i] to first[i + 1] belong to vertex i.
struct Adjacency {
  std::vector<std::size_t> first;
  std::vector<int> neighbour;

  [[nodiscard]] int degree(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return static_cast<int>(first[k + 1] - first[k]);
  }
};

Adjacency adjacency_of(const Mesh& mesh) {
  const auto edges = edges_of(mesh);
  Adjacency result;
  result.first.assign(mesh.rest.size() + 1, 0);
  for (const auto& edge : edges)
    for (const int i : edge) ++result.first[static_cast<std::size_t>(i) + 1];
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) result.first[i + 1] += result.first[i];
  result.neighbour.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (const auto& [i, j] : edges) {
    result.neighbour[next[static_cast<std::size_t>(i)]++] = j;
    result.neighbour[next[static_cast<std::size_t>(j)]++] = i;
  }
  return result;
}

}  // namespace

std::vector<int> reverse_cuthill_mckee(const Mesh& mesh) {
  const Adjacency adjacency = adjacency_of(mesh);
  const auto fewer = [&](int i, int j) {
    return std::pair(adjacency.degree(i), i) < std::pair(adjacency.degree(j), j);
  };
  std::vector<int> starts(mesh.rest.size());
  for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = static_cast<int>(i);
  std::ranges::sort(starts, fewer);
  std::vector<char> seen(starts.size(), 0);
  std::vector<int> order, found;
  for (const int start : starts) {
    if (seen[static_cast<std::size_t>(start)] != 0) continue;
    seen[static_cast<std::size_t>(start)] = 1;
    order.push_back(start);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      const auto i = static_cast<std::size_t>(order[next]);
      found.clear();
      for (std::size_t k = adjacency.first[i]; k < adjacency.first[i + 1]; ++k) {
        const int j = adjacency.neighbour[k];
        if (seen[static_cast<std::size_t>(j)] != 0) continue;
        seen[static_cast<std::size_t>(j)] = 1;
        found.push_back(j);
      }
      std::ranges::sort(found, fewer);
      order.insert(order.end(), found.begin(), found.end());
    }
  }
  std::ranges::reverse(order);
  return order;
}

Mesh renumber(const Mesh& mesh, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  Mesh result;
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    result.rest.push_back(mesh.rest[static_cast<std::size_t>(order[k])]);
  }
  result.triangles = mesh.triangles;
  result.lines = mesh.lines;
  result.line_stiffness = mesh.line_stiffness;
  result.line_density = mesh.line_density;
  result.line_length = mesh.line_length;
  for (auto& triangle : result.triangles)
    for (int& i : triangle) i = place[static_cast<std::size_t>(i)];
  for (auto& line : result.lines)
    for (int& i : line) i = place[static_cast<std::size_t>(i)];
  return result;
}

}  // namespace drogue::mesh
