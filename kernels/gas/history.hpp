#pragma once

#include "kernels/gas/finish.hpp"
#include "kernels/gas/tile.hpp"

namespace drogue::gas {

inline constexpr int sum_radix = 64;       ///< values one thread adds
inline constexpr int row_capacity = 1024;  ///< rows the ring holds until the host has read them

/// One level of the sums over all cells: thread j adds values j, j + n_out, j + 2 n_out, ... in this order,
/// so that the result has the same bits on every backend and with any number of threads.
template <class ExecutionSpace>
struct SumLevelFunctor {
  using Memory = typename ExecutionSpace::memory_space;
  FieldsView<ExecutionSpace> buffer[3];  ///< the first level reads the current state
  Kokkos::View<Control, Memory> control;
  Kokkos::View<double*[3], Kokkos::LayoutLeft, Memory> in, out;
  std::int64_t n_in, n_out;
  bool first;
  bool always;  ///< or only when the step under way has stopped for a row

  KOKKOS_FUNCTION void operator()(std::int64_t j) const {
    const Control& c = control();
    if (!always && (c.attempt.stop != Stop::pause || c.resume.step != c.attempt.row_step)) return;
    const double* source = first ? buffer[c.resume.current].data() : in.data();
    const std::int64_t row = first ? n_in : static_cast<std::int64_t>(in.extent(0));
    double sum[3] = {};
    for (std::int64_t i = j; i < n_in; i += n_out)
      for (int field = 0; field < 3; ++field) sum[field] += source[field * row + i];
    for (int field = 0; field < 3; ++field) out(j, field) = sum[field];
  }
};

/// Adds what the levels left, writes a row of the history and lets the stepping go on.
template <class ExecutionSpace>
struct RowFunctor {
  using Memory = typename ExecutionSpace::memory_space;
  Kokkos::View<Control, Memory> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  Kokkos::View<HistoryRow*, device::HostPinnedSpace<ExecutionSpace>> ring;
  Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory> partial;
  std::int64_t n;
  StepConstants constants;
  int every;  ///< steps between rows; 0: a row that the host asked for
  bool always;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    Attempt attempt = c.attempt;
    if (always || (attempt.stop == Stop::pause && c.resume.step == attempt.row_step)) {
      write_row(c.resume, attempt);
      if (!always) {
        attempt.row_step += every;
        if (c.resume.step != attempt.pause_step) {
          attempt.stop = Stop::running;
          prepare_attempt(c.resume, attempt, c.failed, constants);
          empty(c.outcome, c.resume);
        }
      }
    }
    report(c.resume, attempt, status());
    c.attempt = attempt;
  }

  KOKKOS_FUNCTION void write_row(const Resume& r, Attempt& attempt) const {
    double sum[3] = {};
    for (std::int64_t i = 0; i < n; ++i)
      for (int field = 0; field < 3; ++field) sum[field] += partial(i, field);
    HistoryRow& row = ring(attempt.rows % row_capacity);
    row.time = r.time;
    row.step = r.step;
    row.dt = r.last_dt;
    row.mass = sum[0] * constants.dx;
    row.momentum = sum[1] * constants.dx;
    row.energy = sum[2] * constants.dx;
    for (int field = 0; field < 3; ++field) row.boundary[field] = r.boundary[1][field] - r.boundary[0][field];
    row.max_speed = max_speed(r.speed);
    row.touches = r.touches;
    row.redone = r.redone;
    ++attempt.rows;
  }
};

}  // namespace drogue::gas
