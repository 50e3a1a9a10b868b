#pragma once

#include <cstdint>

#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/stepping/batch_length.hpp"

namespace drogue::coupling {

/// Steps of a run of cloth in air: blocks of steps of the flow with the same dt, each of which holds equal
/// steps of the cloth, and batches of steps that are enqueued at once. On the host; does not throw.
class BlockPlan {
 public:
  static constexpr std::int64_t block_steps = 16;
  /// Largest ratio of the steps of successive blocks.
  static constexpr double largest_growth = 2.0;

  explicit BlockPlan(const Parameters& p);

  [[nodiscard]] const BlockProgress& block() const { return _block; }
  void set(const BlockProgress& block) { _block = block; }
  /// True if a block begins at this step of the flow.
  [[nodiscard]] bool has_ended(std::int64_t step) const { return step >= _block.end; }
  /// Ends the block at this step of the flow.
  void end_at(std::int64_t step) { _block.end = step; }

  /// Largest dt of the next block, s: a fixed one, or that of the flow, `admissible`, which grows by degrees.
  /// The last block may have had half of it, to end at a target, and less in a single step unless one was
  /// planned.
  [[nodiscard]] double longest_dt(double admissible) const;

  /// dt of the block that begins at a time, s. Unless dt is fixed, a whole number of steps reaches a target
  /// within two blocks: a step of the flow changes the velocity at the sheet by itself, and the impulse that
  /// follows would be a large mean force in a far shorter last step.
  [[nodiscard]] double next_dt(double now, double target, double admissible) const;

  /// Number of steps of dt, s, in a block that begins at a time, s: `block_steps`, but where gravity pulls a
  /// point that the frame follows, no more than a sixteenth of the time so far. The frame keeps its velocity
  /// in a block, so that a point that falls from rest then lags by a sixteenth of its fall, instead of
  /// leaving the grid in the first block, for which the air at rest bounds no dt.
  [[nodiscard]] std::int64_t steps_from(double now, double dt) const;

  /// Begins a block with so many steps of the cloth in each step of dt, s, of the flow.
  void begin(const flow::Progress& now, double dt, std::int64_t substeps);

  /// Divides what is left to a target within the block into equal steps, whatever pauses lie between.
  void divide_rest(const flow::Progress& now, double target);

  /// Counts the time of the cloth from now on, s, which a change of dt makes necessary.
  void count_cloth_time_from(double now) { _block.since = _block.cloth_step, _block.start = now; }
  /// Step, time and dt of the cloth.
  [[nodiscard]] fabric::TimeState cloth_time() const;

  /// Begins a batch; number of its steps, of which `left` remain until a pause or the end of the run.
  [[nodiscard]] std::int64_t begin_batch(std::int64_t step, std::int64_t left);
  /// Ends a batch of so many steps of the flow at a step of the cloth. `seconds`: mean time on all ranks.
  /// Chooses how many steps to take before the next poll; it changes no result, as pauses do not.
  void end_batch(std::int64_t steps, std::int64_t cloth_step, double seconds);
  /// Returns to a step of the flow at a time, s, in the last batch: steps that were discarded do not count,
  /// since how many there were depends on when the host noticed.
  void return_to(const flow::Progress& now);

 private:
  double _fixed_dt, _initial_cloth_dt;  ///< s
  bool _follows_a_fall = false;
  BlockProgress _block;
  /// Steps of the flow and of the cloth at which the batch began.
  std::int64_t _batch_step = 0, _batch_cloth_step = 0;
  stepping::BatchLength _batch;  ///< in steps of the flow
};

}  // namespace drogue::coupling
