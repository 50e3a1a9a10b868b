#pragma once

// Definitions of SolverOn: stepping.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "kernels/gas/solver_on.hpp"

namespace drogue::gas {

/// How much work may be in flight, so that progress, interrupts and faults are seen in time.
inline constexpr double seconds_in_flight = 0.1;
inline constexpr std::int64_t most_in_flight = 512;  ///< also keeps the ring of history rows from overflowing

template <class ExecutionSpace>
Status SolverOn<ExecutionSpace>::status() const {
  // The device writes it behind the compiler's back.
  const volatile Status& s = _status();
  Status seen;
  seen.launches = s.launches;
  seen.step = s.step;
  seen.time = s.time;
  seen.dt = s.dt;
  seen.limited = s.limited;
  seen.stop = s.stop;
  seen.rows = s.rows;
  return seen;
}

/// Steps that the stretch up to `target` and `pause_step` still needs, as far as the device's last word
/// tells; at least one. Launches for more would find nothing to do.
inline std::int64_t steps_left(const Status& now, double target, std::int64_t pause_step) {
  double steps = std::ceil((target - now.time) / now.dt);
  if (pause_step > now.step) steps = std::min(steps, static_cast<double>(pause_step - now.step));
  if (!(steps < 1e12)) return 1'000'000'000'000;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
}

/// Calls `launch` with the scheme as a constant.
template <class Launch>
void with_reconstruction(const Parameters& p, const Launch& launch) {
  switch (p.weno) {
    case Weno::js:
      return launch(std::integral_constant<Reconstruction, Reconstruction::js>{});
    case Weno::m:
      return launch(std::integral_constant<Reconstruction, Reconstruction::m>{});
    case Weno::teno5:
      return launch(std::integral_constant<Reconstruction, Reconstruction::teno5>{});
    case Weno::z:
      break;
  }
  if (p.weno_power == 1) return launch(std::integral_constant<Reconstruction, Reconstruction::z1>{});
  return launch(std::integral_constant<Reconstruction, Reconstruction::z2>{});
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::enqueue_step(const ExecutionSpace& space, bool limited) const {
  with_reconstruction(_parameters, [&](auto scheme) {
    if (is_fused()) return launch_step<scheme.value>(space, _setup, _parameters.precision, limited);
    for (int stage = 0; stage < _setup.table.stages; ++stage)
      launch_stage<scheme.value>(space, _setup, _parameters.precision, limited, stage);
  });
  Kokkos::parallel_for(
      "drogue::gas::finish_step",
      Kokkos::Experimental::require(Kokkos::TeamPolicy<ExecutionSpace>(space, 1, on_host ? 1 : finish_team),
                                    Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      FinishFunctor<ExecutionSpace>{_setup.control, _status, _constants, _setup.table, limited});
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::enqueue_sums(const ExecutionSpace& space, int row_every, bool always) const {
  std::int64_t n = _parameters.cells;
  int level = 0;
  for (; level == 0 || n > sum_radix; ++level) {
    const auto out = static_cast<std::int64_t>(_partial[level].extent(0));
    Kokkos::parallel_for(
        "drogue::gas::sum_level", Kokkos::RangePolicy<ExecutionSpace>(space, 0, out),
        SumLevelFunctor<ExecutionSpace>{{_setup.buffer[0], _setup.buffer[1], _setup.buffer[2]},
                                        _setup.control,
                                        _partial[level == 0 ? 0 : level - 1],
                                        _partial[level],
                                        n,
                                        out,
                                        level == 0,
                                        always});
    n = out;
  }
  Kokkos::parallel_for("drogue::gas::history_row", Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1),
                       RowFunctor<ExecutionSpace>{_setup.control, _status, _ring, _partial[level - 1], n,
                                                  _constants, row_every, always});
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::ensure_recorded(bool limited) {
  auto& step = _step[limited ? 1 : 0];
  if (step) return;
  step = std::make_unique<device::CapturedGraph<ExecutionSpace>>(
      _instance, [this, limited](const ExecutionSpace& space) { enqueue_step(space, limited); });
}

/// Enqueues a step, or as many as a persistent kernel takes in one launch.
template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::enqueue(bool limited, std::int64_t most_steps) {
  if (_persistent && !limited)
    return with_reconstruction(_parameters, [&](auto scheme) {
      launch_persistent_steps<scheme.value>(_setup, *_persistent, _parameters.precision, most_steps);
    });
  if (_parameters.driver == Driver::plain) return enqueue_step(_instance.space(), limited);
  ensure_recorded(limited);
  _step[limited ? 1 : 0]->launch();
}

template <class ExecutionSpace>
void SolverOn<ExecutionSpace>::drain_rows(const RowSink& rows) {
  for (const std::int64_t written = status().rows; _rows_read < written; ++_rows_read) {
    _last_row = _ring(static_cast<std::size_t>(_rows_read % row_capacity));
    if (rows) rows(*_last_row);
  }
}

template <class ExecutionSpace>
HistoryRow SolverOn<ExecutionSpace>::totals() {
  enqueue_sums(_instance.space(), 0, true);
  ++_launched;
  _instance.space().fence("drogue::gas::totals");
  drain_rows({});
  return *_last_row;
}

template <class ExecutionSpace>
Stop SolverOn<ExecutionSpace>::advance(double target, std::int64_t pause_step, int row_every,
                                       const RowSink& rows, const Poll& poll) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](auto span) { return std::chrono::duration<double>(span).count(); };
  const ExecutionSpace& space = _instance.space();
  // Also before a stretch that ends sooner than the next look at the clock.
  if (poll && !poll(status())) return Stop::interrupted;
  if (row_every > 0 && row_every != _row_every) {
    _row = std::make_unique<device::CapturedGraph<ExecutionSpace>>(
        _instance, [this, row_every](const ExecutionSpace& on) { enqueue_sums(on, row_every, false); });
    _row_every = row_every;
  }
  const std::int64_t first_step = status().step;
  const std::int64_t row_step = row_every > 0 ? (first_step / row_every + 1) * row_every : -1;
  Kokkos::parallel_for(
      "drogue::gas::resume", Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1),
      ResumeFunctor<ExecutionSpace>{_setup.control, _status, _constants, target, pause_step, row_step});
  ++_launched;
  space.fence("drogue::gas::advance: resumed");

  std::int64_t since_row = row_every > 0 ? first_step % row_every : 0;
  std::int64_t window = on_host ? 1 : 8;
  std::int64_t steps_a_launch = 1024;  // of a persistent kernel
  const auto begin = Clock::now();
  auto last_poll = begin;
  bool interrupted = false;
  while (true) {
    const Status now = status();
    drain_rows(rows);
    const bool row_due = now.stop == Stop::pause && row_every > 0 && now.step % row_every == 0 &&
                         (!_last_row || _last_row->step != now.step);
    if (now.stop != Stop::running && !row_due) {
      if (now.stop != Stop::pause || now.step == pause_step) break;
    }
    const auto clock = Clock::now();
    if (seconds(clock - last_poll) > 0.02 || on_host) {
      last_poll = clock;
      if (poll && !poll(now)) {
        interrupted = true;
        break;
      }
      const double rate = static_cast<double>(now.step - first_step) / seconds(clock - begin);
      if (!on_host)
        window =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(seconds_in_flight * rate), 8, most_in_flight);
      steps_a_launch = std::max<std::int64_t>(static_cast<std::int64_t>(0.5 * seconds_in_flight * rate), 64);
    }
    const std::int64_t in_flight = _launched - now.launches;
    const bool persistent = _persistent && now.limited == 0;
    const std::int64_t left = steps_left(now, target, pause_step);
    // A row ends a launch that holds many steps, and then another begins.
    const std::int64_t useful = !persistent
                                    ? std::min(window, left + (row_every > 0 ? left / row_every + 1 : 0))
                                : row_every > 0 ? 2
                                                : std::min<std::int64_t>(2, (left - 1) / steps_a_launch + 1);
    if (in_flight >= useful) {
      std::this_thread::yield();
      continue;
    }
    if (row_every > 0 && (since_row >= row_every || (in_flight == 0 && row_due))) {
      _row->launch();
      since_row = 0;
    } else {
      enqueue(now.limited != 0, steps_a_launch);
      since_row += persistent ? steps_a_launch : 1;
    }
    ++_launched;
  }
  space.fence("drogue::gas::advance: stopped");
  const Status last = status();
  if (row_every > 0 && last.step % row_every == 0 && last.step > first_step &&
      (drain_rows(rows), !_last_row || _last_row->step != last.step)) {
    const HistoryRow row = totals();
    if (rows) rows(row);
  }
  drain_rows(rows);
  const bool between_stops =
      last.stop == Stop::running || (last.stop == Stop::pause && last.step != pause_step);
  return interrupted && between_stops ? Stop::interrupted : last.stop;
}

}  // namespace drogue::gas
