#include "perf/ladders/weno/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/reference/gas/run.hpp"
#include "perf/ladders/weno/tile_shape.hpp"

namespace drogue::perf::ladder {
namespace {

constexpr int stages = 3;

Work with_arithmetic(const Arithmetic& sum) {
  Work work;
  work.divisions = static_cast<double>(sum.divisions + sum.roots);
  work.flops = static_cast<double>(sum.additions + sum.multiplications);
  return work;
}

}  // namespace

double WenoProblem::dt_over_dx() const {
  return parameters.fixed_dt * static_cast<double>(cells()) / (parameters.x_max - parameters.x_min);
}

WenoProblem make_weno_problem(std::int64_t cells, long steps) {
  WenoProblem problem{sod::parameters(cells), steps, {}, {}};
  gas::Parameters& p = problem.parameters;
  // No wave of Sod's problem is faster than 2.2 m/s.
  p.fixed_dt = p.cfl / 2.2 * (p.x_max - p.x_min) / static_cast<double>(cells);
  problem.start = sod::start(p);
  reference::GasRun run = reference::start_run(p, sod::initial);
  // Ends by the number of steps: the last step before an end time would be shortened.
  gas::Parameters counted = p;
  counted.max_steps = steps;
  reference::advance(run, counted, 2.0 * static_cast<double>(steps) * p.fixed_dt);
  for (const reference::Conserved& u : run.state)
    for (std::size_t k = 0; k < 3; ++k) problem.expected[k].push_back(u[k]);
  return problem;
}

double difference(const WenoProblem& problem, const sod::Fields& got) {
  double worst = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double scale = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < got[k].size(); ++i) {
      const double expected = problem.expected[k][i], off = std::abs(got[k][i] - expected);
      if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
      scale = std::max(scale, std::abs(expected)), largest = std::max(largest, off);
    }
    worst = std::max(worst, largest / scale);
  }
  return worst;
}

Work stage_work(const WenoProblem& problem, double launches, double traffic, const Arithmetic& face) {
  const std::int64_t n = problem.cells(), tiles = n / tile_cells;
  Work work = with_arithmetic(stages * (tiles * tile_slots * load_arithmetic +
                                        tiles * (tile_cells + 1) * face + n * combined_arithmetic));
  work.launches = stages * launches;
  work.bytes = stages * traffic * 8.0 * static_cast<double>(n);
  return work;
}

Work library_work(const WenoProblem& problem, double launches) {
  const StepWork counted = step_work(problem.parameters, {384 - 18, 9, true});
  Work work = with_arithmetic(counted.arithmetic);
  work.bytes = static_cast<double>(counted.bytes);
  work.launches = launches;
  work.packed = true;
  return work;
}

}  // namespace drogue::perf::ladder
