#include "kernels/reference/coupling/grid_transfer.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

namespace {

using coupling::DeltaFunction;
using coupling::StaggeredGrid;

double delta_factor(DeltaFunction delta, bool along, double x) {
  switch (delta) {
    case DeltaFunction::cbs43:
      return b_spline(along ? 4 : 3, x);
    case DeltaFunction::cbs32:
      return b_spline(along ? 3 : 2, x);
    default:
      return peskin_four_point(x);
  }
}

/// Weights of all faces of a component along one axis.
std::vector<double> axis_weights(const StaggeredGrid& grid, DeltaFunction delta, std::size_t component,
                                 std::size_t axis, double x) {
  const bool along = component == axis;
  const int count = faces_along(grid, component, axis);
  const double position = (x - grid.origin[axis]) / grid.spacing[axis] - (along ? 0.0 : 0.5);
  std::vector<double> weights(static_cast<std::size_t>(count), 0.0);
  for (double sample = std::floor(position) - 3.0; sample <= position + 4.0; sample += 1.0) {
    const double cells = grid.cells[axis];
    const double face = grid.periodic[axis] ? sample - cells * std::floor(sample / cells)
                                            : std::clamp(sample, 0.0, count - 1.0);
    weights[static_cast<std::size_t>(face)] += delta_factor(delta, along, sample - position);
  }
  return weights;
}

}  // namespace

double b_spline(int order, double x) {
  if (order == 1) return x >= -0.5 && x < 0.5 ? 1.0 : 0.0;
  const double half = 0.5 * order;
  return ((half + x) * b_spline(order - 1, x + 0.5) + (half - x) * b_spline(order - 1, x - 0.5)) /
         (order - 1.0);
}

double peskin_four_point(double x) {
  const double r = std::abs(x);
  if (r <= 1.0) return (3.0 - 2.0 * r + std::sqrt(1.0 + 4.0 * r - 4.0 * r * r)) / 8.0;
  if (r <= 2.0) return (5.0 - 2.0 * r - std::sqrt(-7.0 + 12.0 * r - 4.0 * r * r)) / 8.0;
  return 0.0;
}

int faces_along(const StaggeredGrid& grid, std::size_t component, std::size_t axis) {
  return component == axis && !grid.periodic[axis] ? grid.cells[axis] + 1 : grid.cells[axis];
}

FaceField zero_field(const StaggeredGrid& grid) {
  FaceField field;
  for (std::size_t d = 0; d < 3; ++d) {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      count *= static_cast<std::size_t>(faces_along(grid, d, axis));
    field[d].assign(count, 0.0);
  }
  return field;
}

std::vector<double> face_weights(const StaggeredGrid& grid, DeltaFunction delta, std::size_t component,
                                 const Vector& point) {
  std::array<std::vector<double>, 3> of_axis;
  for (std::size_t axis = 0; axis < 3; ++axis)
    of_axis[axis] = axis_weights(grid, delta, component, axis, point[axis]);
  std::vector<double> weights;
  for (const double z : of_axis[2])
    for (const double y : of_axis[1])
      for (const double x : of_axis[0]) weights.push_back(x * y * z);
  return weights;
}

std::vector<Vector> interpolate(const StaggeredGrid& grid, DeltaFunction delta, const FaceField& field,
                                const std::vector<Vector>& points) {
  std::vector<Vector> result;
  for (const Vector& point : points) {
    Vector value{};
    for (std::size_t d = 0; d < 3; ++d) {
      const std::vector<double> weights = face_weights(grid, delta, d, point);
      for (std::size_t n = 0; n < weights.size(); ++n) value[d] += weights[n] * field[d][n];
    }
    result.push_back(value);
  }
  return result;
}

FaceField spread(const StaggeredGrid& grid, DeltaFunction delta, const std::vector<Vector>& points,
                 const std::vector<Vector>& forces) {
  const double volume = grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
  FaceField field = zero_field(grid);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) {
      const std::vector<double> weights = face_weights(grid, delta, d, points[i]);
      for (std::size_t n = 0; n < weights.size(); ++n) field[d][n] += weights[n] * forces[i][d] / volume;
    }
  return field;
}

std::vector<Vector> spread_row_sums(const StaggeredGrid& grid, DeltaFunction delta,
                                    const std::vector<Vector>& points, const std::vector<double>& areas,
                                    double density) {
  std::vector<Vector> forces;
  for (const double area : areas) forces.push_back({area / density, area / density, area / density});
  return interpolate(grid, delta, spread(grid, delta, points, forces), points);
}

}  // namespace drogue::reference
