#include "kernels/flow/boundary/side_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "kernels/device/expression.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/make_grid.hpp"
#include "kernels/stepping/motion_steps.hpp"

namespace drogue::flow {
namespace {

using device::Operation;

bool depends_on(const device::ExpressionProgram& program, Operation variable) {
  return std::find(program.operations, program.operations + program.length, variable) !=
         program.operations + program.length;
}

/// Coordinates along an axis at which a component is sampled, m.
std::vector<double> places(const Parameters& p, const MacGrid& grid, int axis, int component, bool depends) {
  constexpr int most = 9;
  const bool on_faces = axis == component;
  const int cells = grid.whole[axis], count = depends ? std::min(cells, most) : 1;
  std::vector<double> result;
  for (int i = 0; i < count; ++i) {
    const int index =
        count == 1 ? 0 : static_cast<int>(static_cast<std::int64_t>(i) * (cells - 1) / (count - 1));
    const auto a = static_cast<std::size_t>(axis);
    result.push_back(!is_stretched(p, a) ? grid.coordinate(axis, index, on_faces)
                     : on_faces          ? face_coordinate(p, a, index)
                                         : centre_coordinate(p, a, index));
  }
  return result;
}

/// Points at which a component of the velocity of a side is sampled, m.
std::vector<std::array<double, 3>> points(const Parameters& p, const MacGrid& grid, int side, int component,
                                          const device::ExpressionProgram& program) {
  const Operation variables[] = {Operation::x, Operation::y, Operation::z};
  std::array<std::vector<double>, 3> along;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (axis == side / 2)
      along[a] = {side % 2 == 0 ? grid.low[axis] : grid.high[axis]};
    else
      along[a] = places(p, grid, axis, component, depends_on(program, variables[axis]));
  }
  std::vector<std::array<double, 3>> result;
  for (const double z : along[2])
    for (const double y : along[1])
      for (const double x : along[0]) result.push_back({x, y, z});
  return result;
}

std::vector<stepping::MotionInterval> motion_of(const Parameters& parameters, const MacGrid& grid, int side) {
  const Boundary& boundary = parameters.boundary[static_cast<std::size_t>(side)];
  std::array<std::vector<std::array<double, 3>>, 3> at;
  stepping::PrescribedMotion motion;
  for (int c = 0; c < 3; ++c) {
    const auto component = static_cast<std::size_t>(c);
    at[component] = points(parameters, grid, side, c, boundary.velocity_expressions[component]);
    motion.values += at[component].size();
  }
  // Velocities over cell widths, so that a rate is their sum; those along an axis of one cell have none.
  motion.evaluate = [&](double time, std::span<double> values) {
    std::size_t i = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (const auto& [x, y, z] : at[c])
        values[i++] = grid.inverse_h[c] * device::evaluate(boundary.velocity_expressions[c], x, y, z, time);
  };
  motion.rate = [&](double /*dt*/, std::span<const double> /*before*/, std::span<const double> after) {
    double rate = 0.0;
    std::size_t i = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      double largest = 0.0;
      for (std::size_t p = 0; p < at[c].size(); ++p, ++i)
        if (grid.n[c] > 1) largest = std::max(largest, std::abs(after[i]));
      rate += largest;
    }
    return rate;
  };
  motion.times = stepping::constants_of(boundary.velocity_expressions);
  return stepping::motion_intervals(motion, parameters.horizon);
}

}  // namespace

std::vector<stepping::MotionInterval> side_motion(const Parameters& parameters) {
  std::vector<stepping::MotionInterval> result = parameters.motion;
  if (!(parameters.horizon > 0.0)) return result;
  const MacGrid grid = make_grid(parameters);
  for (int side = 0; side < 6; ++side) {
    const Boundary& boundary = parameters.boundary[static_cast<std::size_t>(side)];
    if (std::ranges::any_of(boundary.velocity_expressions, changes_in_time))
      result = stepping::merged(result, motion_of(parameters, grid, side));
  }
  return result;
}

double rate_of_constant_sides(const Parameters& parameters) {
  const MacGrid grid = make_grid(parameters);
  double largest = 0.0;
  for (const Boundary& side : parameters.boundary) {
    if (side.kind != BoundaryKind::wall && side.kind != BoundaryKind::inflow) continue;
    double rate = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      if (grid.n[c] > 1) rate += std::abs(side.velocity[c]) * grid.inverse_h[c];
    largest = std::max(largest, rate);
  }
  return largest;
}

}  // namespace drogue::flow
