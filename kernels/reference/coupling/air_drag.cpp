#include "kernels/reference/coupling/air_drag.hpp"

#include <array>
#include <cmath>
#include <functional>

#include "kernels/reference/vectors.hpp"

namespace drogue::reference {
namespace {

/// Calls `visit(line, point, share of the far end)` for all points in their order.
void for_each_drag_point(
    const std::vector<DragLine>& lines,
    const std::function<void(const DragLine& line, std::size_t point, double share)>& visit) {
  std::size_t point = 0;
  for (const DragLine& line : lines)
    for (std::size_t k = 0; k < line.points; ++k, ++point)
      visit(line, point, (2.0 * static_cast<double>(k) + 1.0) / (2.0 * static_cast<double>(line.points)));
}

using DragMatrix = std::array<Vector, 3>;

void add_matrix(double factor, const DragMatrix& a, DragMatrix& sum) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum[i][j] += factor * a[i][j];
}

Vector matrix_times(const DragMatrix& a, const Vector& v) {
  Vector result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i] += a[i][j] * v[j];
  return result;
}

/// Solution of a linear system with a positive definite matrix by elimination.
Vector solve_by_elimination(DragMatrix a, Vector right) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = 0; j < 3; ++j) a[i][j] -= factor * a[k][j];
      right[i] -= factor * right[k];
    }
  return {right[0] / a[0][0], right[1] / a[1][1], right[2] / a[2][2]};
}

}  // namespace

std::vector<Vector> drag_points(const std::vector<DragLine>& lines, const DragState& state, double dt) {
  std::vector<Vector> points;
  for_each_drag_point(lines, [&](const DragLine& line, std::size_t, double share) {
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
  std::vector<Vector> slips(air.size());
  std::vector<DragMatrix> at_point(air.size(), DragMatrix{}), at_vertex(vertices, DragMatrix{});
  std::vector<Vector> drive(vertices, Vector{}), mean(vertices, Vector{});
  for_each_drag_point(lines, [&](const DragLine& line, std::size_t point, double share) {
    Vector chord{};
    Vector& w = slips[point];
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
    Vector direction{};
    for (std::size_t axis = 0; axis < 3 && !is_body; ++axis) direction[axis] = chord[axis] / length;
    const double slip = product(w, direction);
    Vector across{};
    for (std::size_t axis = 0; axis < 3; ++axis) across[axis] = w[axis] - slip * direction[axis];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const double projection = direction[i] * direction[j];
        at_point[point][i][j] = factor * (line.across * norm(across) * ((i == j ? 1.0 : 0.0) - projection) +
                                          line.along * std::abs(slip) * projection);
      }
    const Vector force = matrix_times(at_point[point], w);
    add_matrix(1.0 - share, at_point[point], at_vertex[line.from]);
    add_matrix(share, at_point[point], at_vertex[line.to]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      drive[line.from][axis] -= (1.0 - share) * force[axis];
      drive[line.to][axis] -= share * force[axis];
    }
  });
  const std::vector<Vector> before = state.velocities;
  const double part = dt / parts;
  for (std::size_t i = 0; i < vertices; ++i) {
    const Vector of_start = matrix_times(at_vertex[i], before[i]);
    DragMatrix matrix{};
    for (std::size_t axis = 0; axis < 3; ++axis) matrix[axis][axis] = state.masses[i];
    add_matrix(part, at_vertex[i], matrix);
    for (int k = 0; k < parts; ++k) {
      Vector right{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        right[axis] = state.masses[i] * state.velocities[i][axis] + part * (drive[i][axis] + of_start[axis]);
      state.velocities[i] = solve_by_elimination(matrix, right);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        state.positions[i][axis] += part * state.velocities[i][axis];
        mean[i][axis] += state.velocities[i][axis] / parts;
      }
    }
  }
  std::vector<Vector> force(air.size());
  for_each_drag_point(lines, [&](const DragLine& line, std::size_t point, double share) {
    Vector w{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto loss = [&](std::size_t i) { return before[i][axis] - mean[i][axis]; };
      w[axis] = slips[point][axis] - (1.0 - share) * loss(line.from) - share * loss(line.to);
    }
    const Vector of_line = matrix_times(at_point[point], w);
    for (std::size_t axis = 0; axis < 3; ++axis) force[point][axis] = -of_line[axis];
  });
  return force;
}

}  // namespace drogue::reference
