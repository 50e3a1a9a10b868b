#include "perf/problems/flow_box.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace drogue::perf::flow_box {

namespace {

constexpr double through_speed = 1.0, through_vortices = 0.3;  // m/s
constexpr double endless = std::numeric_limits<double>::max();

flow::Parameters box(const std::array<int, 3>& cells) {
  flow::Parameters p;
  p.cells = cells;
  for (std::size_t axis = 0; axis < 3; ++axis) p.high[axis] = 2.0 * std::numbers::pi * cells[axis] / cells[0];
  p.viscosity = 1.0 / 1600.0;
  return p;
}

bool flows_through(const flow::Parameters& p) { return p.boundary[4].kind == flow::BoundaryKind::inflow; }

/// Sine or cosine of the positions along an axis: of the faces if `on_faces`, else of the cell centres.
std::vector<double> wave(const flow::Parameters& p, std::size_t axis, int count, bool on_faces, bool sine) {
  const double h = (p.high[axis] - p.low[axis]) / p.cells[axis];
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double at = p.low[axis] + (i + (on_faces ? 0.0 : 0.5)) * h;
    values.push_back(sine ? std::sin(at) : std::cos(at));
  }
  return values;
}

}  // namespace

flow::Parameters periodic(const std::array<int, 3>& cells) { return box(cells); }

flow::Parameters through(const std::array<int, 3>& cells) {
  flow::Parameters p = box(cells);
  for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = flow::BoundaryKind::slip;
  p.boundary[4] = {flow::BoundaryKind::inflow, {0.0, 0.0, through_speed}, {}};
  p.boundary[5].kind = flow::BoundaryKind::outflow;
  return p;
}

std::int64_t cell_count(const flow::Parameters& p) {
  return static_cast<std::int64_t>(p.cells[0]) * p.cells[1] * p.cells[2];
}

std::string grid_name(const flow::Parameters& p) {
  return std::to_string(p.cells[0]) + "x" + std::to_string(p.cells[1]) + "x" + std::to_string(p.cells[2]);
}

Velocity start(const flow::Parameters& p) {
  const double amplitude = flows_through(p) ? through_vortices : 1.0;
  Velocity velocity;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::array<int, 3> shape = flow::extents(p, static_cast<flow::StateField>(c));
    const auto count = static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]) *
                       static_cast<std::size_t>(shape[2]);
    if (c == 2) {
      velocity[c].assign(count, flows_through(p) ? through_speed : 0.0);
      continue;
    }
    // u = sin x cos y cos z, v = -cos x sin y cos z
    const std::vector<double> x = wave(p, 0, shape[0], c == 0, c == 0),
                              y = wave(p, 1, shape[1], c == 1, c == 1),
                              z = wave(p, 2, shape[2], false, false);
    velocity[c].reserve(count);
    for (const double of_z : z)
      for (const double of_y : y)
        for (const double of_x : x)
          velocity[c].push_back((c == 0 ? amplitude : -amplitude) * of_x * of_y * of_z);
  }
  return velocity;
}

Sample steps(const flow::Parameters& p, flow::Solver& solver, long count) {
  constexpr long untimed = 2;
  return {[&solver, from = start(p)] {
            for (std::size_t c = 0; c < 3; ++c) solver.upload(static_cast<flow::StateField>(c), from[c]);
            solver.start();
            solver.advance(endless, untimed, {});
          },
          [&solver, count] {
            solver.advance(endless, untimed + count, {});
            return count;
          }};
}

double divergence(const flow::Parameters& p, flow::Solver& solver) {
  const flow::Totals totals = solver.totals();
  double volume = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) volume *= p.high[axis] - p.low[axis];
  const double squared = flows_through(p) ? through_speed * through_speed : 0.0;
  const double amplitude = flows_through(p) ? through_vortices : 1.0;
  const double energy = 0.5 * p.density * volume * (squared + 0.25 * amplitude * amplitude);
  // A failed step leaves dt at zero.
  const bool sound = totals.kinetic_energy > 0.5 * energy && totals.kinetic_energy < 1.5 * energy;
  return sound && totals.dt > 0.0 ? totals.divergence_rms : std::numeric_limits<double>::infinity();
}

}  // namespace drogue::perf::flow_box
