#include "kernels/reference/coupling/air_drag.hpp"

#include <cmath>
#include <functional>

namespace drogue::reference {
namespace {

/// Calls `visit(line, point, share of the far end)` for all points in their order.
void for_each_point(const std::vector<DragLine>& lines,
                    const std::function<void(const DragLine& line, std::size_t point, double share)>& visit) {
  std::size_t point = 0;
  for (const DragLine& line : lines)
    for (std::size_t k = 0; k < line.points; ++k, ++point)
      visit(line, point, (2.0 * static_cast<double>(k) + 1.0) / (2.0 * static_cast<double>(line.points)));
}

double norm(const Vector& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

}  // namespace

std::vector<Vector> drag_points(const std::vector<DragLine>& lines, const DragState& state, double dt) {
  std::vector<Vector> points;
  for_each_point(lines, [&](const DragLine& line, std::size_t, double share) {
    Vector& at = points.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto end = [&](std::size_t i) {
        return state.positions[i][axis] + 0.5 * dt * state.velocities[i][axis];
      };
      at[axis] = (1.0 - share) * end(line.from) + share * end(line.to);
    }
  });
  return points;
}

std::vector<Vector> take_drag_step(const std::vector<DragLine>& lines, const std::vector<Vector>& air,
                                   double density, double dt, int parts, DragState& state) {
  const std::size_t vertices = state.masses.size();
  std::vector<Vector> force(air.size());
  std::vector<double> change(air.size()), rate(vertices, 0.0);
  std::vector<Vector> first(vertices, Vector{}), impulse(vertices, Vector{});
  for_each_point(lines, [&](const DragLine& line, std::size_t point, double share) {
    Vector chord{}, w{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto middle = [&](std::size_t i) {
        return state.positions[i][axis] + 0.5 * dt * state.velocities[i][axis];
      };
      chord[axis] = middle(line.to) - middle(line.from);
      w[axis] = (1.0 - share) * state.velocities[line.from][axis] + share * state.velocities[line.to][axis] -
                air[point][axis];
    }
    const bool is_body = line.from == line.to;
    const double length = norm(chord),
                 factor = 0.5 * density * (is_body ? 1.0 : length / static_cast<double>(line.points));
    Vector along{};
    double slip = 0.0;
    for (std::size_t axis = 0; axis < 3 && !is_body; ++axis) slip += w[axis] * chord[axis] / length;
    for (std::size_t axis = 0; axis < 3 && !is_body; ++axis) along[axis] = slip * chord[axis] / length;
    const Vector across = {w[0] - along[0], w[1] - along[1], w[2] - along[2]};
    for (std::size_t axis = 0; axis < 3; ++axis)
      force[point][axis] =
          -factor * (line.across * norm(across) * across[axis] + line.along * norm(along) * along[axis]);
    change[point] = 2.0 * factor * (line.across * norm(across) + line.along * norm(along));
    rate[line.from] += (1.0 - share) * change[point];
    rate[line.to] += share * change[point];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[line.from][axis] += (1.0 - share) * force[point][axis];
      first[line.to][axis] += share * force[point][axis];
    }
  });
  const std::vector<Vector> before = state.velocities;
  const double part = dt / parts;
  for (std::size_t i = 0; i < vertices; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int k = 0; k < parts; ++k) {
        double& v = state.velocities[i][axis];
        const double old = v;
        v = before[i][axis] + (old - before[i][axis] + part / state.masses[i] * first[i][axis]) /
                                  (1.0 + part / state.masses[i] * rate[i]);
        impulse[i][axis] += state.masses[i] * (v - old);
        state.positions[i][axis] += part * v;
      }
  // What each end has lost of its velocity changes the force at the points of its lines.
  for_each_point(lines, [&](const DragLine& line, std::size_t point, double share) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto loss = [&](std::size_t i) {
        return rate[i] > 0.0 ? (impulse[i][axis] / dt - first[i][axis]) / rate[i] : 0.0;
      };
      force[point][axis] += change[point] * ((1.0 - share) * loss(line.from) + share * loss(line.to));
    }
  });
  return force;
}

}  // namespace drogue::reference
