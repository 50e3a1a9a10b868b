#include "kernels/reference/gas/run.hpp"

#include <algorithm>
#include <optional>

#include "kernels/reference/gas/stage.hpp"

namespace drogue::reference {

namespace {

enum class TrialResult { done, too_fast, not_physical };

/// One stage: the share of the state at the start of the step, and the fraction of dt of its Euler step.
struct Stage {
  double keep;
  double dt_fraction;
};

/// Shu and Osher 1988 (three stages); Spiteri and Ruuth 2002 (four stages).
std::vector<Stage> stages(gas::TimeScheme scheme) {
  if (scheme == gas::TimeScheme::ssprk3) return {{0.0, 1.0}, {3.0 / 4.0, 1.0}, {1.0 / 3.0, 1.0}};
  return {{0.0, 0.5}, {0.0, 0.5}, {2.0 / 3.0, 0.5}, {0.0, 0.5}};
}

double spacing(const gas::Parameters& p) { return (p.x_max - p.x_min) / static_cast<double>(p.cells); }

double proposed_dt(const GasRun& run, const gas::Parameters& p, bool limited) {
  if (p.fixed_dt > 0.0) return p.fixed_dt;
  const double cap = p.time_scheme == gas::TimeScheme::ssprk43 ? 0.8 : 0.4;
  const double cfl = limited ? std::min(p.cfl, cap) : p.cfl;
  const double ramp =
      run.steps < p.ramp_steps ? 0.1 + 0.9 * static_cast<double>(run.steps) / p.ramp_steps : 1.0;
  return ramp * cfl * spacing(p) / speed_bounds(run.state, p.gamma).largest;
}

/// Tries one step. Changes `run` only on success.
TrialResult try_step(GasRun& run, const gas::Parameters& p, double dt, bool limited) {
  std::vector<Conserved> cells = run.state;
  std::int64_t limited_faces = 0;
  for (const Stage& stage : stages(p.time_scheme)) {
    const double lambda = stage.dt_fraction * dt / spacing(p);
    if (limited && lambda * speed_bounds(cells, p.gamma).largest > 0.5) return TrialResult::too_fast;
    const StageFluxes fluxes = stage_fluxes(cells, p, limited ? std::optional(lambda) : std::nullopt);
    cells = stage_update(run.state, cells, fluxes.flux, stage.keep, lambda);
    limited_faces += fluxes.limited_faces;
    if (!is_physical(cells, p.gamma)) return TrialResult::not_physical;
  }
  run.state = std::move(cells);
  run.limited_faces += limited_faces;
  return TrialResult::done;
}

/// Steps for which positivity `automatic` keeps the limiter on.
constexpr std::int64_t limiter_stays = 100;

}  // namespace

double cell_centre(const gas::Parameters& p, std::size_t i) {
  return p.x_min + (static_cast<double>(i) + 0.5) * spacing(p);
}

GasRun start_run(const gas::Parameters& p, const std::function<Primitive(double)>& initial) {
  GasRun run;
  run.state.reserve(static_cast<std::size_t>(p.cells));
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.cells); ++i)
    run.state.push_back(to_conserved(initial(cell_centre(p, i)), p.gamma));
  return run;
}

void advance(GasRun& run, const gas::Parameters& p, double end_time) {
  while (run.time < end_time && !run.failed) {
    run.failed = run.steps == p.max_steps;
    if (run.failed) return;
    bool limited = p.positivity == gas::Positivity::on || run.limited_steps_left > 0;
    const double remaining = end_time - run.time;
    double dt = std::min(proposed_dt(run, p, limited), remaining);
    TrialResult result = try_step(run, p, dt, limited);
    while (result != TrialResult::done) {
      if (result == TrialResult::too_fast && p.fixed_dt > 0.0) {
        break;
      } else if (result == TrialResult::too_fast) {
        dt *= 0.5;
      } else if (p.positivity == gas::Positivity::automatic && !limited) {
        limited = true;
        run.limited_steps_left = limiter_stays;
        dt = std::min(proposed_dt(run, p, limited), remaining);
      } else {
        break;
      }
      ++run.redone_steps;
      result = try_step(run, p, dt, limited);
    }
    run.failed = result != TrialResult::done;
    if (run.failed) return;
    run.time = dt == remaining ? end_time : run.time + dt;
    ++run.steps;
    if (run.limited_steps_left > 0) --run.limited_steps_left;
  }
}

GasRun reference_run(const gas::Parameters& p, const std::function<Primitive(double)>& initial,
                     double end_time, std::span<const double> output_times) {
  GasRun run = start_run(p, initial);
  for (const double time : output_times) advance(run, p, std::min(time, end_time));
  advance(run, p, end_time);
  return run;
}

double l1_density(const GasRun& run, const gas::Parameters& p, const std::function<double(double)>& exact) {
  double sum = 0.0;
  for (std::size_t i = 0; i < run.state.size(); ++i)
    sum += std::abs(run.state[i][0] - exact(cell_centre(p, i)));
  return sum * spacing(p);
}

}  // namespace drogue::reference
