#pragma once

#include <array>
#include <optional>

#include "kernels/device/captured_graph.hpp"
#include "kernels/gas/history.hpp"
#include "kernels/gas/launch.hpp"
#include "kernels/gas/solver.hpp"
#include "kernels/gas/transfer.hpp"

namespace drogue::gas {

/// The solver on one execution space: three field buffers, a control block, and two recorded steps (with and
/// without the flux limiter) of which the device runs the one that its control block asks for.
template <class ExecutionSpace>
class SolverOn final : public Solver {
 public:
  explicit SolverOn(const Parameters& parameters);

  void upload(std::int64_t first, const ConstConserved& fields) override;
  void download(std::int64_t first, const Conserved& fields) override;
  void start() override;
  void restore(const Resume& state) override;
  Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
               const Poll& poll) override;
  HistoryRow totals() override;
  Resume resume_state() override { return read_control().resume; }
  Failed failure() override { return read_control().failed; }
  std::int64_t touched_cells() override;
  void download_touched(std::int64_t first, std::span<std::uint8_t> cells) override;
  void upload_touched(std::int64_t first, std::span<const std::uint8_t> cells) override;
  void begin_snapshot() override;
  ConstConserved finish_snapshot() override;
  [[nodiscard]] Phases phases() const override { return {}; }
  [[nodiscard]] const char* driver() const override;
  [[nodiscard]] Tiling tiling() const override;

 private:
  using Memory = typename ExecutionSpace::memory_space;
  using Report = device::HostPinnedSpace<ExecutionSpace>;
  using Fields = FieldsView<ExecutionSpace>;
  using HostFields = Kokkos::View<double* [3], Kokkos::LayoutLeft, Report>;
  static constexpr bool on_host = device::is_host<ExecutionSpace>;

  [[nodiscard]] Control read_control() const;
  void write_control(const Control& control);
  void begin_at(Control& control);
  [[nodiscard]] Status status() const;
  /// Whether all stages of a step are one kernel.
  [[nodiscard]] bool is_fused() const {
    return _setup.splitting == Splitting::lf_stencil && _parameters.driver != Driver::stages;
  }
  void enqueue_step(const ExecutionSpace& space, bool limited) const;
  void enqueue_sums(const ExecutionSpace& space, int row_every, bool always) const;
  void make_persistent();
  void ensure_recorded(bool limited);
  void enqueue(bool limited, std::int64_t most_steps);
  void drain_rows(const RowSink& rows);

  device::Instance<ExecutionSpace> _instance;
  device::Instance<ExecutionSpace> _copy_instance;
  Parameters _parameters;
  StepConstants _constants;
  StageSetup<ExecutionSpace> _setup;
  Kokkos::View<Status, Report> _status;
  Kokkos::View<HistoryRow*, Report> _ring;
  std::array<Fields, 4> _partial;  ///< sums after each level
  std::array<std::unique_ptr<device::CapturedGraph<ExecutionSpace>>, 2> _step;
  std::unique_ptr<device::CapturedGraph<ExecutionSpace>> _row;
  std::optional<PersistentSetup<ExecutionSpace>> _persistent;
  int _row_every = 0;
  Fields _snapshot;
  HostFields _host_snapshot;
  std::int64_t _rows_read = 0;
  std::int64_t _launched = 0;  ///< kernels that report, enqueued so far
  std::optional<HistoryRow> _last_row;
};

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters) {
  return std::make_unique<SolverOn<ExecutionSpace>>(parameters);
}

}  // namespace drogue::gas

#include "kernels/gas/solver_on_advance.hpp"
#include "kernels/gas/solver_on_state.hpp"
