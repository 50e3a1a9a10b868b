#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/program/signals.hpp"
#include "common/study/repeats.hpp"
#include "perf/problems/inflation.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

namespace {

using inflation::Discretization;

constexpr study::Repeats canopy_repeats{5, 0.5};

/// A number that a flight is measured by.
struct Measure {
  const char* problem;
  double (inflation::Forces::*value)() const;
};

/// Flights of a canopy that are compared.
struct Flights {
  inflation::Problem (*problem)(const Discretization&);
  double end_time;  ///< s
  std::vector<Measure> measures;
  double reference_inset;  ///< cells, of the solution that errors refer to
};

std::vector<Flights> flights(bool quick) {
  return {
      {inflation::problem,
       quick ? 0.05 : 1.0,
       {{"opening-impulse", &inflation::Forces::impulse}, {"opening-time", &inflation::Forces::half_time}},
       0.0},
      {inflation::porous_problem, quick ? 0.2 : 2.0, {{"porous-drag", &inflation::Forces::late_mean}}, 0.55}};
}

/// Grids with twice as many cells along the stream as across it.
struct Grids {
  std::vector<int> across;  ///< numbers of cells, at most half of `reference`
  int reference;            ///< cells across of the solution that errors refer to
};

Grids grids_of(device::Backend backend, bool quick) {
  if (quick) return {{8, 12}, 24};
  if (device::needs_device(backend)) return {{15, 30, 45, 60}, 120};
  return {{12, 16, 20}, 40};
}

Discretization on_grid(Discretization d, int across) {
  d.cells = {across, across, 2 * across};
  return d;
}

/// Discretizations but for the grid. The first has the settings of drogue-parachute with plain coupling. Each
/// other one changes the mesh of the cloth, the time step, the time scheme, or the delta function of the
/// coupling, its inset and its corrections.
std::vector<Discretization> discretizations(bool quick) {
  std::vector<Discretization> all = {{}};
  const auto add = [&](auto change) {
    all.emplace_back();
    change(all.back());
  };
  add([](Discretization& d) { d.edge = 0.35; });
  add([](Discretization& d) { d.cfl = 0.5; });
  if (quick) return all;
  add([](Discretization& d) { d.cfl = 0.125; });
  for (const double cfl : {0.5, 1.0})
    add([&](Discretization& d) {
      d.time_scheme = flow::TimeScheme::rk3;
      d.cfl = cfl;
    });
  add([](Discretization& d) { d.delta = coupling::DeltaFunction::cbs32; });
  add([](Discretization& d) { d.delta = coupling::DeltaFunction::ib4; });
  add([](Discretization& d) { d.edge_inset = 0.55; });
  add([](Discretization& d) { d.corrected = true; });
  return all;
}

/// The finest in space, of air and cloth, and in time.
Discretization reference_of(const Grids& grids, double edge_inset) {
  return on_grid({.cfl = 0.125, .edge = 0.5, .edge_inset = edge_inset}, grids.reference);
}

/// Delta function, with inset of edges and corrections where there are.
std::string exchange_of(const Discretization& d) {
  std::string name = d.delta == coupling::DeltaFunction::cbs43   ? "cbs43"
                     : d.delta == coupling::DeltaFunction::cbs32 ? "cbs32"
                                                                 : "ib4";
  if (d.edge_inset != 0.0) name += " inset " + nlohmann::json(d.edge_inset).dump();
  if (d.corrected) name += " corrected";
  return name;
}

Solution described(device::Backend backend, const Discretization& d) {
  const std::string time =
      (d.time_scheme == flow::TimeScheme::ab2 ? "ab2 " : "rk3 ") + nlohmann::json(d.cfl).dump();
  const std::string edge = nlohmann::json(d.edge).dump();
  Solution s;
  s.backend = backend;
  s.label = exchange_of(d) + " " + time + " edge " + edge;
  s.scheme = {{"kernel", exchange_of(d)}, {"time", time}, {"edge", edge}};
  s.cells = d.cells[0];
  return s;
}

/// Forces of a flight, whose runs are equal, and in `samples` the durations of one run or, with `repeated`,
/// of several; nothing after a signal.
std::optional<inflation::Forces> fly(device::Backend backend, const Flights& flights, const Discretization& d,
                                     std::vector<double>& samples, bool repeated) {
  const inflation::Problem problem = flights.problem(d);
  const std::unique_ptr<coupling::Solver> solver = coupling::create_solver(backend, problem.parameters);
  std::optional<inflation::Forces> result;
  // The first run on a GPU captures the steps.
  if (repeated && device::needs_device(backend) && !inflation::forces(problem, *solver, flights.end_time))
    return {};
  do {
    result = inflation::forces(problem, *solver, flights.end_time);
    if (!result) return {};
    samples.push_back(result->seconds);
  } while (repeated && !canopy_repeats.reached(samples));
  return result;
}

/// Measures the flights on all grids with all discretizations; false after a signal.
bool measure(const Flights& flights, device::Backend backend, bool quick, const SolutionSink& sink) {
  const Grids grids = grids_of(backend, quick);
  std::vector<double> unused;
  const auto reference = fly(backend, flights, reference_of(grids, flights.reference_inset), unused, false);
  if (!reference) return false;
  for (const Discretization& changed : discretizations(quick))
    for (const int across : grids.across) {
      const Discretization d = on_grid(changed, across);
      Solution s = described(backend, d);
      inflation::Forces found;
      try {
        const auto flown = fly(backend, flights, d, s.samples, true);
        if (!flown) return false;
        found = *flown;
      } catch (const Failure& failure) {
        if (failure.code() != ExitCode::numerical_failure) throw;
        s.samples.clear();
        s.code = failure.code();
        s.message = failure.what();
      }
      s.steps = found.steps;
      for (const Measure& measure : flights.measures) {
        s.problem = measure.problem;
        if (s.code == ExitCode::ok) {
          const double truth = ((*reference).*measure.value)();
          s.error = std::abs((found.*measure.value)() - truth) / truth;
        }
        s.sound = s.code == ExitCode::ok && std::isfinite(s.error);
        sink(s);
      }
    }
  return true;
}

}  // namespace

bool parachute_work_precision(const Selection& selection, const SolutionSink& sink) {
  std::vector<Flights> wanted = flights(selection.quick);
  for (Flights& one : wanted)
    std::erase_if(one.measures, [&](const Measure& measure) { return !selection.wants(measure.problem); });
  std::erase_if(wanted, [](const Flights& one) { return one.measures.empty(); });
  for (const device::Backend backend : selection.backends)
    for (const Flights& one : wanted)
      if (!measure(one, backend, selection.quick, sink)) return false;
  return true;
}

}  // namespace drogue::perf
