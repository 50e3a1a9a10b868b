#include "perf/problems/streams.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "common/program/failure.hpp"

namespace drogue::perf::streams {

namespace {

/// Initial velocity component at a point, m/s.
double initial_velocity(Sides sides, std::size_t component, const std::array<double, 3>& x) {
  const double pi = std::numbers::pi;
  if (sides != Sides::tunnel) {
    if (component == 2) return 0.0;
    return component == 0 ? std::sin(x[0]) * std::cos(x[1]) * std::cos(x[2])
                          : -std::cos(x[0]) * std::sin(x[1]) * std::cos(x[2]);
  }
  if (component == 1) return 0.0;
  return component == 0 ? 0.2 * std::sin(2.0 * pi * x[2]) * std::cos(pi * x[1])
                        : 1.0 + 0.2 * std::cos(pi * x[1]) * std::sin(2.0 * pi * x[0]);
}

Sides sides_of(const flow::Parameters& p) {
  switch (p.boundary[0].kind) {
    case flow::BoundaryKind::periodic:
      return Sides::periodic;
    case flow::BoundaryKind::wall:
      return Sides::walls;
    default:
      return Sides::tunnel;
  }
}

void upload_initial_velocity(const flow::Parameters& p, flow::Solver& solver) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto field = static_cast<flow::StateField>(c);
    const std::array<int, 3> n = flow::extents(p, field);
    std::vector<double> values;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const std::array<int, 3> index = {i, j, k};
          std::array<double, 3> x{};
          for (std::size_t axis = 0; axis < 3; ++axis)
            x[axis] = p.low[axis] +
                      (index[axis] + (axis == c ? 0.0 : 0.5)) * (p.high[axis] - p.low[axis]) / p.cells[axis];
          values.push_back(initial_velocity(sides_of(p), c, x));
        }
    solver.upload(field, values);
  }
}

}  // namespace

const char* name(Sides sides) {
  return sides == Sides::periodic ? "periodic" : sides == Sides::walls ? "walls" : "tunnel";
}

std::string text(const std::array<int, 3>& cells) {
  return std::to_string(cells[0]) + "x" + std::to_string(cells[1]) + "x" + std::to_string(cells[2]);
}

flow::Parameters parameters(const std::array<int, 3>& cells, Sides sides) {
  flow::Parameters p;
  p.cells = cells;
  if (sides != Sides::tunnel) {
    p.high.fill(2.0 * std::numbers::pi);
    p.viscosity = 1.0 / 1600.0;
    if (sides == Sides::walls)
      for (flow::Boundary& side : p.boundary) side.kind = flow::BoundaryKind::wall;
    return p;
  }
  // Cubes as cells; one metre along x.
  for (std::size_t axis = 0; axis < 3; ++axis)
    p.high[axis] = static_cast<double>(cells[axis]) / static_cast<double>(cells[0]);
  p.viscosity = 1e-3;
  for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = flow::BoundaryKind::slip;
  p.boundary[4].kind = flow::BoundaryKind::inflow;
  p.boundary[4].velocity = {0.0, 0.0, 1.0};
  p.boundary[5].kind = flow::BoundaryKind::outflow;
  return p;
}

linear::PoissonProblem pressure_problem(const std::array<int, 3>& cells, Sides sides) {
  linear::PoissonProblem problem;
  problem.cells = cells;
  for (linear::AxisConditions& axis : problem.axes) axis.periodic = sides == Sides::periodic;
  if (sides == Sides::tunnel) problem.axes[2].high = linear::EndCondition::dirichlet;
  return problem;
}

Sample steps(const flow::Parameters& p, flow::Solver& solver, long count) {
  const auto started = std::make_shared<bool>(false);
  return {[=, &solver] {
            if (*started) return;
            upload_initial_velocity(p, solver);
            solver.start();
            *started = true;
          },
          [=, &solver] {
            const std::int64_t last = solver.progress().step + count;
            if (solver.advance(std::numeric_limits<double>::max(), last, {}) != flow::Stop::pause)
              throw Failure(ExitCode::numerical_failure, "a step of the flow benchmark failed");
            return count;
          }};
}

double relative_divergence(const flow::Parameters& p, flow::Solver& solver) {
  const flow::Totals totals = solver.totals();
  return totals.divergence_rms * (p.high[0] - p.low[0]) / p.cells[0] / totals.max_speed;
}

}  // namespace drogue::perf::streams
