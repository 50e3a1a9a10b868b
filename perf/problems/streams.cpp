#include "perf/problems/streams.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/thread_parts.hpp"

namespace drogue::perf::streams {

namespace {

/// Velocity on the faces, component by component, m/s.
using VelocityArrays = std::array<std::vector<double>, 3>;

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

/// Values of a function (component, point) on the faces of each component, x fastest; by all cores.
template <class Function>
VelocityArrays sampled(const flow::Parameters& p, const Function& function) {
  VelocityArrays arrays;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::array<int, 3> n = flow::extents(p, c);
    const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
    const std::size_t size = nx * ny * static_cast<std::size_t>(n[2]);
    arrays[c].resize(size);
    constexpr std::size_t faces_per_thread = 50'000;
    for_thread_parts(
        thread_parts(size, faces_per_thread), size,
        [&](std::size_t /*part*/, std::size_t begin, std::size_t end) {
          for (std::size_t entry = begin; entry < end; ++entry) {
            const std::array<std::size_t, 3> index = {entry % nx, entry / nx % ny, entry / (nx * ny)};
            std::array<double, 3> x{};
            for (std::size_t axis = 0; axis < 3; ++axis)
              x[axis] = p.low[axis] + (static_cast<double>(index[axis]) + (axis == c ? 0.0 : 0.5)) *
                                          (p.high[axis] - p.low[axis]) / p.cells[axis];
            arrays[c][entry] = function(c, x);
          }
        });
  }
  return arrays;
}

void start_from(flow::Solver& solver, const VelocityArrays& arrays) {
  for (std::size_t c = 0; c < 3; ++c) solver.upload(flow::velocity_name(c), arrays[c]);
  solver.start();
}

void advance_by(flow::Solver& solver, long count) {
  const std::int64_t last = solver.progress().step + count;
  if (solver.advance(std::numeric_limits<double>::max(), last, {}) != flow::Stop::pause)
    throw Failure(ExitCode::numerical_failure, "a step of the flow benchmark failed");
}

/// Velocity component of vortices of Taylor and Green that drift and decay, m/s.
double drifting_vortices(double nu, std::size_t component, const std::array<double, 3>& x, double time) {
  constexpr double drift[] = {1.0, 0.5, 0.25};  // m/s
  const double a = x[0] - drift[0] * time, b = x[1] - drift[1] * time, decay = std::exp(-2.0 * nu * time);
  if (component == 2) return drift[2];
  return drift[component] + decay * (component == 0 ? std::sin(a) * std::cos(b) : -std::cos(a) * std::sin(b));
}

/// Velocity component of a vortex that the stream of the tunnel carries and viscosity spreads, m/s: Taylor
/// 1918, with its axis along y. Its circulation is zero, so that its velocity vanishes at the sides.
double carried_vortex(const flow::Parameters& p, std::size_t component, const std::array<double, 3>& x,
                      double time) {
  if (component == 1) return 0.0;
  constexpr double radius = 0.1, speed = 0.5;  // m and m/s, at the largest speed about the axis
  const double stream = p.boundary[4].velocity[2], nu = p.viscosity / p.density;
  const double a = x[0] - 0.5, b = x[2] - 0.5 * p.high[2] - stream * time;
  const double first = 2.0 * radius * radius, spread = first + 4.0 * nu * time;
  const double rotation =
      speed / radius * (first / spread) * (first / spread) * std::exp(0.5 - (a * a + b * b) / spread);
  return component == 0 ? -rotation * b : stream + rotation * a;
}

double exact_velocity(const flow::Parameters& p, std::size_t component, const std::array<double, 3>& x,
                      double time) {
  return sides_of(p) == Sides::periodic ? drifting_vortices(p.viscosity / p.density, component, x, time)
                                        : carried_vortex(p, component, x, time);
}

/// Sum of the squared differences of all values.
double squared_distance(const VelocityArrays& a, const VelocityArrays& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i) sum += (a[c][i] - b[c][i]) * (a[c][i] - b[c][i]);
  return sum;
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
  p.time_scheme = flow::TimeScheme::ab2;  // one projection per step, as in most published timings
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

Sample steps(const flow::Parameters& p, const std::shared_ptr<flow::Solver>& solver, long count) {
  return {[=, started = false]() mutable {
            if (started) return;
            start_from(*solver, sampled(p, [&](std::size_t c, const std::array<double, 3>& x) {
              return initial_velocity(sides_of(p), c, x);
            }));
            started = true;
          },
          [=] {
            advance_by(*solver, count);
            return count;
          },
          [=] { return relative_divergence(p, *solver); }};
}

double relative_divergence(const flow::Parameters& p, flow::Solver& solver) {
  const flow::Totals totals = solver.totals();
  return totals.divergence_rms * (p.high[0] - p.low[0]) / p.cells[0] / totals.max_speed;
}

double exact_error(const flow::Parameters& p, flow::Solver& solver, long count) {
  const auto exact = [&](double time) {
    return sampled(
        p, [&](std::size_t c, const std::array<double, 3>& x) { return exact_velocity(p, c, x, time); });
  };
  const VelocityArrays first = exact(0.0);
  start_from(solver, first);
  advance_by(solver, count);
  const VelocityArrays last = exact(solver.progress().time);
  VelocityArrays computed = last;
  for (std::size_t c = 0; c < 3; ++c) solver.download(flow::velocity_name(c), computed[c]);
  return std::sqrt(squared_distance(computed, last) / squared_distance(last, first));
}

}  // namespace drogue::perf::streams
