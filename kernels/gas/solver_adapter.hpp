#pragma once

#include "kernels/gas/gas_solver.hpp"
#include "kernels/gas/host_threads.hpp"

namespace drogue::gas {

/// `GasSolver` behind the virtual interface, on an execution-space instance of its own.
template <class ExecutionSpace>
class SolverAdapter final : public Solver {
 public:
  explicit SolverAdapter(const Parameters& p) : _instance(host_threads(p)), _solver(_instance, p) {}

  void upload(std::int64_t first, const ConstConservedFields& fields) override {
    _solver.upload(first, fields);
  }
  void download(std::int64_t first, const ConservedFields& fields) override {
    _solver.download(first, fields);
  }
  void start() override { _solver.start(); }
  void restore(const RestartState& state) override { _solver.restore(state); }
  Stop advance(double target, std::int64_t pause_step, int row_every, const RowSink& rows,
               const Poll& poll) override {
    return _solver.advance(target, pause_step, row_every, rows, poll);
  }
  HistoryRow totals() override { return _solver.totals(); }
  RestartState restart_state() override { return _solver.restart_state(); }
  StepFailure failure() override { return _solver.failure(); }
  std::int64_t limited_cells() override { return _solver.limited_cells(); }
  void download_limited_cells(std::int64_t first, std::span<std::uint8_t> cells) override {
    _solver.download_limited_cells(first, cells);
  }
  void upload_limited_cells(std::int64_t first, std::span<const std::uint8_t> cells) override {
    _solver.upload_limited_cells(first, cells);
  }
  void begin_snapshot() override { _solver.begin_snapshot(); }
  ConstConservedFields finish_snapshot() override { return _solver.finish_snapshot(); }
  [[nodiscard]] PhaseTimes phase_times() const override { return {}; }
  [[nodiscard]] const char* driver() const override { return _solver.driver(); }
  [[nodiscard]] Tiling tiling() const override { return _solver.tiling(); }

 private:
  device::Instance<ExecutionSpace> _instance;
  GasSolver<ExecutionSpace> _solver;
};

/// Solver on `ExecutionSpace`. Throws as the constructor of GasSolver does.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters) {
  return std::make_unique<SolverAdapter<ExecutionSpace>>(parameters);
}

}  // namespace drogue::gas
