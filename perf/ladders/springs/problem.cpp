#include "perf/ladders/springs/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include "kernels/mesh/renumbering.hpp"
#include "kernels/reference/fabric/scatter_step.hpp"

namespace drogue::perf::ladder {
namespace {

double squared_distance(const fabric::Vector& a, const fabric::Vector& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// The order that results from one order and a second one of its result.
std::vector<int> reordered(const std::vector<int>& first, const std::vector<int>& second) {
  std::vector<int> sorted = second, all(first.size());
  std::ranges::sort(sorted);
  std::iota(all.begin(), all.end(), 0);
  if (sorted != all) throw std::invalid_argument("the order of the vertices does not hold each of them once");
  std::vector<int> order;
  for (const int k : second) order.push_back(first[static_cast<std::size_t>(k)]);
  return order;
}

/// `order`: as `mesh::renumber` takes it.
Numbering make_numbering(const fabric::Parameters& p, const std::vector<int>& order, long steps, double dt) {
  Numbering n{p, {}, {}, {}};
  n.parameters.mesh = mesh::renumber(p.mesh, order);
  for (std::size_t i = 0; i < order.size(); ++i) {
    n.parameters.mass[i] = p.mass[static_cast<std::size_t>(order[i])];
    n.parameters.pinned[i] = p.pinned[static_cast<std::size_t>(order[i])];
  }
  const auto& rest = n.parameters.mesh.rest;
  n.triangles.resize(rest.size());
  for (const auto& t : n.parameters.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner[3] = {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
      const auto at = [&](int c) { return rest[static_cast<std::size_t>(corner[c])]; };
      n.triangles[static_cast<std::size_t>(corner[0])].push_back(
          {corner[1],
           corner[2],
           {squared_distance(at(1), at(2)), squared_distance(at(2), at(0)), squared_distance(at(0), at(1))}});
    }
  for (const auto& around : n.triangles)
    if (around.size() > most_triangles) throw std::invalid_argument("too many triangles meet at a vertex");
  n.start = n.expected = sheet::start(n.parameters);
  reference::ScatterSheet loop(n.parameters);
  for (long step = 0; step < steps; ++step) loop.step(dt, n.expected.x, n.expected.v);
  return n;
}

}  // namespace

SpringProblem make_spring_problem(int vertices, long steps, VertexOrder reorder) {
  const fabric::Parameters p = sheet::parameters(vertices);
  const double young = p.material.membrane_modulus, nu = p.material.poisson;
  const double lambda = young * nu / (1.0 - nu * nu), mu = young / (1.0 + nu);
  // A tenth of the time that a wave along the membrane takes to pass the shortest edge: stable.
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& t : p.mesh.triangles)
    shortest = std::min(shortest, squared_distance(p.mesh.rest[static_cast<std::size_t>(t[0])],
                                                   p.mesh.rest[static_cast<std::size_t>(t[1])]));
  constexpr double area_density = 0.1;  // kg/m^2, as sheet::parameters
  const double dt = 0.1 * std::sqrt(shortest * area_density / (young / (1.0 - nu * nu)));
  std::vector<int> order(p.mesh.rest.size());
  std::iota(order.begin(), order.end(), 0);
  const Numbering renumbered = make_numbering(p, order, steps, dt);
  std::mt19937 bits(7);
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[bits() % (i + 1)]);
  if (reorder != nullptr) order = reordered(order, reorder(mesh::renumber(p.mesh, order)));
  return {.scattered = make_numbering(p, order, steps, dt),
          .renumbered = renumbered,
          .steps = steps,
          .dt = dt,
          .two_lambda_mu = 2.0 * (lambda + mu),
          .mu = mu};
}

double difference(const Numbering& n, const std::vector<fabric::Vector>& x) {
  double largest = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = squared_distance(x[i], n.expected.x[i]);
    if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, off);
    scale = std::max(scale, squared_distance(n.start.x[i], n.expected.x[i]));
  }
  return std::sqrt(largest / scale);
}

Work spring_work(const SpringProblem& problem, double launches, double stored, double flops) {
  constexpr double stages = 4.0, around = 6.0;
  const auto vertices = static_cast<double>(problem.renumbered.vertices());
  Work work;
  work.launches = stages * launches;
  // Per stage: positions and velocities of the stage, of the step and the sums in; those of the next stage
  // and the sums out: 30 numbers and the mass. Neighbours come from caches.
  work.bytes = stages * vertices * (8.0 * 31.0 + around * (8.0 * stored + 2.0 * sizeof(int)));
  work.flops = stages * vertices * (around * flops + 50.0);
  return work;
}

}  // namespace drogue::perf::ladder
