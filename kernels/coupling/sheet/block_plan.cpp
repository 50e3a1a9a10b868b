#include "kernels/coupling/sheet/block_plan.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::coupling {
namespace {

/// Number of steps of dt, s, that reach a time left, s, without one for a rounding.
double steps_to(double left, double dt) { return std::ceil((1.0 - 1e-9) * left / dt); }

}  // namespace

BlockPlan::BlockPlan(const Parameters& p)
    : _fixed_dt(p.flow.fixed_dt), _initial_cloth_dt(p.fabric.dt), _batch(p.longest_batch, block_steps) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    _follows_a_fall = _follows_a_fall ||
                      (!p.follow.vertices.empty() && p.follow.axes[axis] && p.fabric.gravity[axis] != 0.0);
}

double BlockPlan::longest_dt(double admissible) const {
  if (_fixed_dt > 0.0) return _fixed_dt;
  const bool has_predecessor =
      _block.dt > 0.0 && _block.cloth_step - _block.since >=
                             _block.substeps * std::min<std::int64_t>(2, steps_from(_block.start, _block.dt));
  return has_predecessor ? std::min(admissible, largest_growth * _block.dt) : admissible;
}

double BlockPlan::next_dt(double now, double target, double admissible) const {
  const double dt = longest_dt(admissible), left = target - now, needed = steps_to(left, dt);
  return !(_fixed_dt > 0.0) && needed <= 2.0 * block_steps ? left / std::max(1.0, needed) : dt;
}

std::int64_t BlockPlan::steps_from(double now, double dt) const {
  constexpr double largest_part = 1.0 / 16.0;
  if (!_follows_a_fall || now * largest_part >= dt * static_cast<double>(block_steps)) return block_steps;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(now * largest_part / dt));
}

void BlockPlan::begin(const flow::Progress& now, double dt, std::int64_t substeps) {
  _block.dt = dt;
  _block.substeps = substeps;
  _block.end = now.step + steps_from(now.time, dt);
  count_cloth_time_from(now.time);
}

void BlockPlan::divide_rest(const flow::Progress& now, double target) {
  const auto steps = static_cast<double>(_block.end - now.step);
  const double left = target - now.time, needed = steps_to(left, _block.dt);
  if (needed > steps || std::abs(left - steps * _block.dt) <= 1e-9 * left) return;
  _block.end = now.step + std::max<std::int64_t>(1, static_cast<std::int64_t>(needed));
  _block.dt = left / static_cast<double>(_block.end - now.step);
  count_cloth_time_from(now.time);
}

fabric::TimeState BlockPlan::cloth_time() const {
  const double dt = _block.dt > 0.0 ? _block.dt / static_cast<double>(_block.substeps) : _initial_cloth_dt;
  return {_block.cloth_step, dt, _block.since, _block.start};
}

std::int64_t BlockPlan::begin_batch(std::int64_t step, std::int64_t left) {
  _batch_step = step, _batch_cloth_step = _block.cloth_step;
  return std::min({_block.end - step, left, _batch.steps()});
}

void BlockPlan::end_batch(std::int64_t steps, std::int64_t cloth_step, double seconds) {
  _block.cloth_step = cloth_step;
  _batch.adapt(steps, seconds);
}

void BlockPlan::return_to(const flow::Progress& now) {
  _block.cloth_step = _batch_cloth_step + (now.step - _batch_step) * _block.substeps;
  count_cloth_time_from(now.time);
}

}  // namespace drogue::coupling
