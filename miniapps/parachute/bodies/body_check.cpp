#include "miniapps/parachute/bodies/body_check.hpp"

#include <string>

#include "common/scene/read.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using scene::contradict;
using scene::real_text;
using scene::Table;

constexpr double most_vertices = 1048576.0;  // 2^20

double spacing(const flow::Parameters& p, std::size_t axis) {
  return lattice_of(p, flow::StateField::pressure).spacing[axis];
}

bool is_bounded(const flow::Parameters& p, std::size_t axis) {
  return p.cells[axis] > 1 && p.boundary[2 * axis].kind != flow::BoundaryKind::periodic;
}

/// Checks the extent of a body along an axis, m. The forces of a sheet act up to one cell beyond it.
void check_extent(const Table& root, const flow::Parameters& p, const std::string& key,
                  const std::string& place, std::size_t axis, double low, double high) {
  const double margin = is_bounded(p, axis) ? spacing(p, axis) : 0.0;
  const double rounding = 1e-9 * (p.high[axis] - p.low[axis]);
  if (low >= p.low[axis] + margin - rounding && high <= p.high[axis] - margin + rounding) return;
  contradict(root, key,
             place + " reaches from " + real_text(low) + " to " + real_text(high) + " m along " +
                 axis_names[axis] + ", beyond " +
                 (margin > 0.0 ? "the cells beside the sides of the domain" : "the domain") +
                 ": it must lie between " + real_text(p.low[axis] + margin) + " and " +
                 real_text(p.high[axis] - margin) + " m");
}

void check_body(const Table& root, const FlowScene& scene, std::size_t index) {
  const Body& body = scene.bodies[index];
  const flow::Parameters& p = scene.parameters;
  const std::string name = "body[" + std::to_string(index) + "]", edge_length = name + ".edge_length";
  const auto axes = body.axes();
  const auto edges = body.edges();
  const auto normal = static_cast<std::size_t>(body.normal);
  if (p.cells[normal] == 1)
    contradict(root, name + ".normal", name + ".normal: the grid has one cell along " + axis_names[normal]);
  double vertices = 1.0;
  for (std::size_t k = 0; k < 2; ++k) {
    vertices *= edges[k] + 1.0;
    const double edge = body.lengths[k] / edges[k], h = spacing(p, axes[k]);
    if (p.cells[axes[k]] > 1 && edge > (1.0 + 1e-9) * largest_edge_in_cells * h)
      contradict(root, edge_length,
                 edge_length + ": edges of " + real_text(edge) + " m along " + axis_names[axes[k]] +
                     " leak on cells of " + real_text(h) + " m; at most " +
                     real_text(largest_edge_in_cells * h) + " m");
    check_extent(root, p, name + ".lengths", name, axes[k], body.centre[axes[k]] - 0.5 * body.lengths[k],
                 body.centre[axes[k]] + 0.5 * body.lengths[k]);
  }
  check_extent(root, p, name + ".centre", name, normal, body.centre[normal], body.centre[normal]);
  if (vertices > most_vertices)
    contradict(root, edge_length, edge_length + ": " + real_text(vertices) + " vertices are more than 2^20");
}

}  // namespace

void check_bodies(const Table& root, const FlowScene& scene) {
  if (scene.bodies.empty()) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) check_body(root, scene, i);
  const flow::Parameters& p = scene.parameters;
  if (p.fixed_dt == 0.0 && p.max_dt == 0.0)
    contradict(root, "run",
               "missing key \"run.max_dt\" (needed with a [[body]] and dt = \"auto\"): fluid at rest does "
               "not limit dt");
}

}  // namespace drogue::parachute_app
