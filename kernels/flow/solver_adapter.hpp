#pragma once

#include "kernels/flow/flow_solver.hpp"
#include "kernels/flow/host_threads.hpp"

namespace drogue::flow {

/// `FlowSolver` behind the virtual interface, on an execution-space instance of its own.
template <class ExecutionSpace>
class SolverAdapter final : public Solver {
 public:
  SolverAdapter(const Parameters& p, const linear::RankGroup& group)
      : _instance(host_threads<ExecutionSpace>(p, group)), _solver(_instance, p, group) {}

  void upload(StateField field, std::span<const double> values) override { _solver.upload(field, values); }
  void download(StateField field, std::span<double> values) override { _solver.download(field, values); }
  void start() override { _solver.start(); }
  void restore(const Progress& progress) override { _solver.restore(progress); }
  Stop advance(double target, std::int64_t pause_step, const Poll& poll) override {
    return _solver.advance(target, pause_step, poll);
  }
  Progress progress() override { return _solver.progress(); }
  StepFailure failure() override { return _solver.failure(); }
  Totals totals() override { return _solver.totals(); }
  Extremes extremes() override { return _solver.extremes(); }
  void set_extremes(const Extremes& extremes) override { _solver.set_extremes(extremes); }
  void sample(CellField field, std::span<double> values) override { _solver.sample(field, values); }
  [[nodiscard]] const char* driver() const override { return _solver.driver(); }
  [[nodiscard]] const char* pressure_solver() const override { return _solver.pressure_solver(); }
  [[nodiscard]] std::optional<PressureSolve> last_pressure_solve() const override {
    return _solver.last_pressure_solve();
  }

 private:
  device::Instance<ExecutionSpace> _instance;
  FlowSolver<ExecutionSpace> _solver;
};

/// Facade of a solver on `ExecutionSpace`. Throws as the constructor of FlowSolver does.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters, const linear::RankGroup& group) {
  return std::make_unique<SolverAdapter<ExecutionSpace>>(parameters, group);
}

}  // namespace drogue::flow
