#pragma once

#include "kernels/gas/stepping/finish_step.hpp"
#include "kernels/gas/tile/tile.hpp"

namespace drogue::gas {

inline constexpr int sum_radix = 64;  ///< values that one thread adds
inline constexpr int row_capacity =
    2 * stepping::max_launches_in_flight;  ///< capacity of the ring of rows that the host has not read yet

/// One level of the sums over all cells. Thread j adds the values j, j + n_out, j + 2 n_out, ... in this
/// order, so that the result has the same bits on every backend and for any number of threads.
template <class ExecutionSpace>
struct SumLevelFunctor {
  using Memory = typename ExecutionSpace::memory_space;
  FieldsView<ExecutionSpace> buffer[3];  ///< read by the first level
  Kokkos::View<Control, Memory> control;
  Kokkos::View<double*[3], Kokkos::LayoutLeft, Memory> in, out;
  std::int64_t n_in, n_out;
  bool first;
  bool always;  ///< otherwise only if the stepping has stopped for a row

  KOKKOS_FUNCTION void operator()(std::int64_t j) const {
    const Control& c = control();
    if (!always && !stepping::output_is_due(c.restart, c.trial)) return;
    const double* source = first ? buffer[c.restart.current].data() : in.data();
    const std::int64_t row = first ? n_in : static_cast<std::int64_t>(in.extent(0));
    double sum[3] = {};
    for (std::int64_t i = j; i < n_in; i += n_out)
      for (int field = 0; field < 3; ++field) sum[field] += source[field * row + i];
    for (int field = 0; field < 3; ++field) out(j, field) = sum[field];
  }
};

/// Adds the last partial sums, writes a history row and resumes the stepping.
template <class ExecutionSpace>
struct RowFunctor {
  using Memory = typename ExecutionSpace::memory_space;
  Kokkos::View<Control, Memory> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  Kokkos::View<HistoryRow*, device::HostPinnedSpace<ExecutionSpace>> ring;
  Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory> partial;
  std::int64_t n;
  StepConstants constants;
  int every;  ///< steps between rows; 0: a row that the host requested
  bool always;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    StepTrial trial = c.trial;
    if (always || stepping::output_is_due(c.restart, trial)) {
      write_row(c.restart, trial);
      if (!always && stepping::resume_after_output(c.restart, trial, every)) {
        prepare_trial(c.restart, trial, c.failure, constants);
        reset(c.reduction, c.restart);
      }
    }
    stepping::publish_status(c.restart, trial, c.restart.limited, status());
    c.trial = trial;
  }

  KOKKOS_FUNCTION void write_row(const RestartState& r, StepTrial& trial) const {
    double sum[3] = {};
    for (std::int64_t i = 0; i < n; ++i)
      for (int field = 0; field < 3; ++field) sum[field] += partial(i, field);
    HistoryRow& row = ring(trial.outputs % row_capacity);
    row.time = r.time;
    row.step = r.step;
    row.dt = r.last_dt;
    row.mass = sum[0] * constants.dx;
    row.momentum = sum[1] * constants.dx;
    row.energy = sum[2] * constants.dx;
    for (int field = 0; field < 3; ++field) row.boundary[field] = r.boundary[1][field] - r.boundary[0][field];
    row.max_speed = max_speed(r.speed);
    row.limited_faces = r.limited_faces;
    row.redone = r.redone;
    ++trial.outputs;
  }
};

}  // namespace drogue::gas
