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

constexpr study::Repeats opening_repeats{5, 0.5};
constexpr const char* impulse_problem = "opening-impulse";
constexpr const char* time_problem = "opening-time";

/// Grids with twice as many cells along the stream as across it.
struct Grids {
  std::vector<int> across;  ///< numbers of cells, at most half of `reference`
  int reference;            ///< cells across of the solution that errors refer to
  double end_time;          ///< s
};

Grids grids_of(device::Backend backend, bool quick) {
  if (quick) return {{8, 12}, 24, 0.05};
  if (device::needs_device(backend)) return {{15, 30, 45, 60}, 120, 1.0};
  return {{12, 16, 20}, 40, 1.0};
}

Discretization on_grid(Discretization d, int across) {
  d.cells = {across, across, 2 * across};
  return d;
}

/// Discretizations but for the grid. The first has the settings of drogue-parachute. Each other one changes
/// the mesh of the cloth, the time step, the time scheme, or the delta function of the coupling.
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
  add([](Discretization& d) { d.kernel = coupling::DeltaKernel::cbs32; });
  add([](Discretization& d) { d.kernel = coupling::DeltaKernel::ib4; });
  return all;
}

/// The finest in space, of air and cloth, and in time.
Discretization reference_of(const Grids& grids) {
  return on_grid({.cfl = 0.125, .edge = 0.5}, grids.reference);
}

const char* name_of(coupling::DeltaKernel kernel) {
  return kernel == coupling::DeltaKernel::cbs43   ? "cbs43"
         : kernel == coupling::DeltaKernel::cbs32 ? "cbs32"
                                                  : "ib4";
}

Solution described(device::Backend backend, const Discretization& d) {
  const std::string time =
      (d.time_scheme == flow::TimeScheme::ab2 ? "ab2 " : "rk3 ") + nlohmann::json(d.cfl).dump();
  const std::string edge = nlohmann::json(d.edge).dump();
  Solution s;
  s.backend = backend;
  s.label = std::string(name_of(d.kernel)) + " " + time + " edge " + edge;
  s.scheme = {{"kernel", name_of(d.kernel)}, {"time", time}, {"edge", edge}};
  s.cells = d.cells[0];
  return s;
}

/// Opening, whose runs are equal, and in `samples` the durations of one run or, with `repeated`, of several;
/// nothing after a signal.
std::optional<inflation::Opening> run_opening(device::Backend backend, const Discretization& d,
                                              double end_time, std::vector<double>& samples, bool repeated) {
  const inflation::Problem problem = inflation::problem(d);
  const std::unique_ptr<coupling::Solver> solver = coupling::create_solver(backend, problem.parameters);
  std::optional<inflation::Opening> result;
  // The first run on a GPU captures the steps.
  if (repeated && device::needs_device(backend) && !inflation::opening(problem, *solver, end_time)) return {};
  do {
    result = inflation::opening(problem, *solver, end_time);
    if (!result) return {};
    samples.push_back(result->seconds);
  } while (repeated && !opening_repeats.reached(samples));
  return result;
}

}  // namespace

bool parachute_work_precision(const Selection& selection, const SolutionSink& sink) {
  const bool impulse = selection.wants(impulse_problem), time = selection.wants(time_problem);
  if (!impulse && !time) return true;
  for (const device::Backend backend : selection.backends) {
    const Grids grids = grids_of(backend, selection.quick);
    std::vector<double> unused;
    const auto reference = run_opening(backend, reference_of(grids), grids.end_time, unused, false);
    if (!reference) return false;
    for (const Discretization& changed : discretizations(selection.quick))
      for (const int across : grids.across) {
        const Discretization d = on_grid(changed, across);
        Solution s = described(backend, d);
        inflation::Opening found;
        try {
          const auto opening = run_opening(backend, d, grids.end_time, s.samples, true);
          if (!opening) return false;
          found = *opening;
        } catch (const Failure& failure) {
          if (failure.code() != ExitCode::numerical_failure) throw;
          s.samples.clear();
          s.code = failure.code();
          s.message = failure.what();
        }
        s.steps = found.steps;
        const auto give = [&](const char* problem, double value, double truth) {
          s.problem = problem;
          if (s.code == ExitCode::ok) s.error = std::abs(value - truth) / truth;
          s.sound = s.code == ExitCode::ok && std::isfinite(s.error);
          sink(s);
        };
        if (impulse) give(impulse_problem, found.impulse, reference->impulse);
        if (time) give(time_problem, found.half_time, reference->half_time);
      }
  }
  return true;
}

}  // namespace drogue::perf
