#include "perf/problems/inflation.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <memory_resource>
#include <string>
#include <utility>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "kernels/coupling/sheet/restart_state.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "perf/measure/timed_parts.hpp"

namespace drogue::perf::inflation {

namespace {

constexpr double speed = 10.0;  // m/s

/// State that a sample begins from.
struct State {
  std::pmr::vector<std::pmr::vector<double>> flow;  ///< arrays of `flow::state_fields`
  flow::Progress progress;
  coupling::RestartState sheets;
};

void save(coupling::Solver& solver, const coupling::Parameters& p, State& state) {
  const auto fields = flow::state_fields(p.flow);
  state.flow.resize(fields.size());
  for (std::size_t k = 0; k < fields.size(); ++k) {
    state.flow[k].resize(flow::state_size(p.flow, fields[k]));
    solver.download(fields[k], state.flow[k]);
  }
  state.progress = solver.progress();
  state.sheets = coupling::download_restart_state(solver, p.fabric.mass.size());
}

void restore(coupling::Solver& solver, const coupling::Parameters& p, const State& state) {
  std::size_t k = 0;
  for (const flow::StateField field : flow::state_fields(p.flow)) solver.upload(field, state.flow[k++]);
  solver.restore(state.progress);
  coupling::upload_restart_state(solver, state.sheets);
}

/// Puts the flat cloth into the uniform stream.
void start(coupling::Solver& solver, const Problem& problem) {
  const std::vector<double> stream(flow::state_size(problem.parameters.flow, flow::StateField::velocity_z),
                                   speed);
  solver.upload(flow::StateField::velocity_z, stream);
  solver.upload_cloth(problem.positions, std::vector<fabric::Vector>(problem.positions.size()));
  solver.start();
}

void fly_to(coupling::Solver& solver, double time) {
  if (solver.advance(time, -1, {}) != flow::Stop::target)
    throw Failure(ExitCode::numerical_failure, "a step of the parachute benchmark failed");
}

}  // namespace

Problem problem(const Discretization& d) {
  Problem result;
  coupling::Parameters& p = result.parameters;
  p.flow.cells = d.cells;
  p.flow.low = {-6.0, -6.0, -9.0};
  p.flow.high = {6.0, 6.0, 15.0};
  p.flow.density = 1.225;
  p.flow.viscosity = 1.8e-5;
  for (std::size_t side = 0; side < 4; ++side) p.flow.boundary[side].kind = flow::BoundaryKind::slip;
  p.flow.boundary[4].kind = flow::BoundaryKind::inflow;
  p.flow.boundary[4].velocity = {0.0, 0.0, speed};
  p.flow.boundary[5].kind = flow::BoundaryKind::outflow;
  p.flow.time_scheme = d.time_scheme;
  p.flow.cfl = d.cfl;
  p.flow.max_dt = 0.01;
  parachute_app::Canopy c9;
  c9.edge_length = d.edge * (p.flow.high[0] - p.flow.low[0]) / d.cells[0];
  c9.payload.fixed = true;
  parachute_app::Sheets canopy = parachute_app::make_all_sheets({}, {c9}, p.flow.density, p.flow.viscosity);
  p.fabric = std::move(canopy.fabric);
  p.sheet.law_of_vertex = std::move(canopy.laws);
  p.sheet.kernel = d.kernel;
  p.fabric.contact.self = d.with_contact;
  result.positions = std::move(canopy.positions);
  return result;
}

Sample flight(const Problem& problem, coupling::Solver& solver, double lead, long milliseconds) {
  const auto state = std::make_shared<State>();
  return {[=, &problem, &solver] {
            if (!state->flow.empty()) return restore(solver, problem.parameters, *state);
            start(solver, problem);
            fly_to(solver, lead);
            save(solver, problem.parameters, *state);
          },
          [=, &solver] {
            fly_to(solver, state->progress.time + 1e-3 * static_cast<double>(milliseconds));
            return milliseconds;
          }};
}

Sample copied_steps(const Problem& problem, coupling::Solver& solver, double lead, long steps,
                    const std::shared_ptr<std::pmr::memory_resource>& memory) {
  struct Run {
    std::shared_ptr<std::pmr::memory_resource> memory;
    State start, now;
    std::map<std::string, double> parts;
  };
  using Arrays = std::pmr::vector<std::pmr::vector<double>>;
  const auto run = std::make_shared<Run>(memory, State(), State{Arrays(memory.get()), {}, {}});
  return {[=, &problem, &solver] {
            if (run->start.flow.empty()) {
              start(solver, problem);
              fly_to(solver, lead);
              save(solver, problem.parameters, run->start);
            }
            run->now = run->start;
          },
          [=, &problem, &solver] {
            State& now = run->now;
            // The time never arrives: the number of steps ends the work.
            const auto step = [&] {
              if (solver.advance(now.progress.time + 1e3, now.progress.step + steps, {}) != flow::Stop::pause)
                throw Failure(ExitCode::numerical_failure, "a step of the parachute benchmark failed");
            };
            run->parts = timed_parts([&] { restore(solver, problem.parameters, now); }, step,
                                     [&] { save(solver, problem.parameters, now); });
            return steps;
          },
          [=] { return run->parts; }};
}

std::optional<Opening> opening(const Problem& problem, coupling::Solver& solver, double end_time) {
  constexpr int intervals = 50;
  const double dt = end_time / intervals;
  start(solver, problem);
  Opening result;
  std::vector<double> given = {0.0};  // momentum, N s, after each interval
  double before = 0.0;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 1; k <= intervals; ++k) {
    if (interrupted()) return {};
    fly_to(solver, k * dt);
    const double force = -solver.total_force_on_air()[2];
    given.push_back(given.back() + 0.5 * dt * (before + force));
    before = force;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.steps = solver.progress().step;
  result.impulse = given.back();
  const double half = 0.5 * result.impulse;
  const auto after = std::ranges::find_if(given, [&](double value) { return value >= half; });
  if (after != given.begin() && after != given.end())
    result.half_time =
        dt * (static_cast<double>(after - given.begin()) - (*after - half) / (*after - *(after - 1)));
  return result;
}

double imbalance(const coupling::Parameters& p, coupling::Solver& solver) {
  const flow::Totals totals = solver.totals();
  const double spacing = (p.flow.high[0] - p.flow.low[0]) / p.flow.cells[0];
  std::vector<fabric::Vector> on_air(p.fabric.mass.size());
  solver.forces(on_air);
  return std::max(totals.divergence_rms * spacing / totals.max_speed,
                  parachute_app::force_balance(solver.total_force_on_air(), on_air));
}

}  // namespace drogue::perf::inflation
