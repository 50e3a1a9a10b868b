#include "perf/problems/inflation.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <memory_resource>
#include <string>
#include <utility>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "kernels/coupling/sheet/corrections.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "perf/measure/parts.hpp"

namespace drogue::perf::inflation {

namespace {

constexpr double speed = 10.0;  // m/s

/// State that a sample begins from.
struct State {
  std::pmr::vector<std::pmr::vector<double>> flow;    ///< arrays of `flow::Solver::state`
  std::map<std::string, std::vector<double>> sheets;  ///< arrays of `coupling::Solver::state`
  coupling::Progress progress;
};

void save(coupling::Solver& solver, State& state) {
  const std::vector<stepping::StateArray> arrays = solver.flow().state();
  state.flow.resize(arrays.size());
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    state.flow[k].resize(arrays[k].size());
    solver.flow().download(arrays[k].name, state.flow[k]);
  }
  state.progress = solver.progress();
  for (const stepping::StateArray& array : solver.state()) {
    state.sheets[array.name].resize(array.size());
    solver.download(array.name, state.sheets[array.name]);
  }
}

void restore(coupling::Solver& solver, const State& state) {
  std::size_t k = 0;
  for (const stepping::StateArray& array : solver.flow().state())
    solver.flow().upload(array.name, state.flow[k++]);
  for (const auto& [name, values] : state.sheets) solver.upload(name, values);
  solver.restore(state.progress);
}

/// Puts the cloth into the uniform stream.
void start(coupling::Solver& solver, const Problem& problem) {
  for (const stepping::StateArray& array : solver.flow().state())
    if (array.name == "velocity_z")
      solver.flow().upload(array.name, std::vector<double>(array.size(), speed));
  solver.fabric().upload(problem.positions, std::vector<fabric::Vector>(problem.positions.size()));
  solver.start();
}

void fly_to(coupling::Solver& solver, double time) {
  if (solver.advance(time, -1, {}) != flow::Stop::target)
    throw Failure(ExitCode::numerical_failure, "a step of the parachute benchmark failed");
}

/// Solver of a problem, with the state that samples begin from.
struct Run {
  Problem problem;
  std::unique_ptr<coupling::Solver> solver;
  double lead;
  State start = {};

  Run(device::Backend backend, const Problem& of, double seconds)
      : problem(of), solver(coupling::create_solver(backend, of.parameters)), lead(seconds) {}

  [[nodiscard]] const coupling::Parameters& parameters() const { return problem.parameters; }

  /// Restores the state after `lead` seconds, which the first call computes.
  void begin() {
    if (!start.flow.empty()) return restore(*solver, start);
    inflation::start(*solver, problem);
    fly_to(*solver, lead);
    save(*solver, start);
  }
};

/// The corrections that drogue-parachute has by default.
void correct(coupling::Parameters& p, double cfl) {
  p.sheet.leak_filter = coupling::standard_leak_filter;
  p.sheet.edge_inset = coupling::standard_edge_inset(p.sheet.delta, cfl);
  p.sheet.filter_of_vertex.assign(p.fabric.mass.size(), {.by_law = true});
}

/// The canopy in the stream, with a fixed payload and edges of the discretization.
Problem with_canopy(const Discretization& d, parachute_app::Canopy canopy) {
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
  canopy.edge_length = d.edge * (p.flow.high[0] - p.flow.low[0]) / d.cells[0];
  canopy.payload.fixed = true;
  parachute_app::Sheets sheets =
      parachute_app::make_all_sheets({}, {canopy}, p.flow.density, p.flow.viscosity);
  p.fabric = std::move(sheets.fabric);
  p.sheet.law_of_vertex = std::move(sheets.laws);
  p.sheet.delta = d.delta;
  p.sheet.edge_inset = d.edge_inset;
  if (d.corrected) correct(p, d.cfl);
  p.fabric.contact.self = d.with_contact;
  result.positions = std::move(sheets.positions);
  return result;
}

/// Integral, s times their unit, of values at equal intervals by the trapezoidal rule, from the first one to
/// each.
std::vector<double> integrals(const std::vector<double>& values, double interval) {
  std::vector<double> result = {0.0};
  for (std::size_t k = 1; k < values.size(); ++k)
    result.push_back(result.back() + 0.5 * interval * (values[k - 1] + values[k]));
  return result;
}

}  // namespace

Problem problem(const Discretization& d) { return with_canopy(d, {}); }

Problem porous_problem(const Discretization& d) {
  // Shape and cloth of the scene porous-c9.
  parachute_app::Canopy canopy;
  canopy.shape = parachute_app::CanopyShape::partly_closed;
  canopy.closure = 0.7;
  canopy.porosity.law = parachute_app::PorosityLaw::ergun;
  canopy.porosity.void_fraction = 0.6;
  canopy.porosity.thickness = 3e-4;
  canopy.porosity.grain = 1e-4;
  return with_canopy(d, canopy);
}

Sample flight(device::Backend backend, const Problem& problem, double lead, long milliseconds) {
  const auto run = std::make_shared<Run>(backend, problem, lead);
  return {[=] { run->begin(); },
          [=] {
            fly_to(*run->solver, run->start.progress.flow.time + 1e-3 * static_cast<double>(milliseconds));
            return milliseconds;
          },
          [=] { return imbalance(run->parameters(), *run->solver); }};
}

Sample copied_steps(device::Backend backend, const Problem& problem, double lead, long steps,
                    HostMemory memory) {
  struct Copies {
    std::shared_ptr<std::pmr::memory_resource> memory;
    State state;
    std::map<std::string, double> parts;
  };
  using Arrays = std::pmr::vector<std::pmr::vector<double>>;
  const auto run = std::make_shared<Run>(backend, problem, lead);
  const auto resource = host_memory(backend, memory);
  const auto now = std::make_shared<Copies>(resource, State{Arrays(resource.get()), {}, {}});
  return {[=] {
            run->begin();
            now->state = run->start;
          },
          [=] {
            // The time never arrives: the number of steps ends the work.
            const auto step = [&] {
              const flow::Progress& from = now->state.progress.flow;
              if (run->solver->advance(from.time + 1e3, from.step + steps, {}) != flow::Stop::pause)
                throw Failure(ExitCode::numerical_failure, "a step of the parachute benchmark failed");
            };
            now->parts = timed_parts([&] { restore(*run->solver, now->state); }, step,
                                     [&] { save(*run->solver, now->state); });
            return steps;
          },
          [=] { return imbalance(run->parameters(), *run->solver); }, [=] { return now->parts; }};
}

double Forces::impulse() const { return integrals(values, interval).back(); }

double Forces::half_time() const {
  const std::vector<double> given = integrals(values, interval);
  const double half = 0.5 * given.back();
  const auto after = std::ranges::find_if(given, [&](double value) { return value >= half; });
  if (after == given.begin() || after == given.end()) return 0.0;
  return interval * (static_cast<double>(after - given.begin()) - (*after - half) / (*after - *(after - 1)));
}

double Forces::late_mean() const {
  const std::vector<double> given = integrals(values, interval);
  const std::size_t middle = (given.size() - 1) / 2;
  return (given.back() - given[middle]) / (interval * static_cast<double>(given.size() - 1 - middle));
}

std::optional<Forces> forces(const Problem& problem, coupling::Solver& solver, double end_time) {
  constexpr int intervals = 50;
  start(solver, problem);
  Forces result;
  result.interval = end_time / intervals;
  result.values = {0.0};
  const Stopwatch stopwatch;
  for (int k = 1; k <= intervals; ++k) {
    if (interrupted()) return {};
    fly_to(solver, k * result.interval);
    result.values.push_back(-solver.total_force_on_air()[2]);
  }
  result.seconds = stopwatch.seconds();
  result.steps = solver.progress().flow.step;
  return result;
}

double imbalance(const coupling::Parameters& p, coupling::Solver& solver) {
  const flow::Totals totals = solver.flow().totals();
  const double spacing = (p.flow.high[0] - p.flow.low[0]) / p.flow.cells[0];
  std::vector<fabric::Vector> on_air(p.fabric.mass.size());
  solver.download("sheet_force", coupling::numbers(on_air));
  return std::max(totals.divergence_rms * spacing / totals.max_speed,
                  parachute_app::force_balance(solver.total_force_on_air(), on_air));
}

}  // namespace drogue::perf::inflation
