#pragma once

#include "kernels/coupling/sheet/coupled_solver.hpp"
#include "kernels/flow/host_threads.hpp"

namespace drogue::coupling {

/// `CoupledSolver` behind the virtual interface, on an execution-space instance of its own.
template <class ExecutionSpace>
class SolverAdapter final : public Solver {
 public:
  SolverAdapter(const Parameters& p, const linear::RankGroup& group)
      : _instance(flow::host_threads<ExecutionSpace>(p.flow, group)), _solver(_instance, p, group) {}

  void upload(flow::StateField field, std::span<const double> values) override {
    _solver.flow().upload(field, values);
  }
  void download(flow::StateField field, std::span<double> values) override {
    _solver.flow().download(field, values);
  }
  void start() override { _solver.start(); }
  void restore(const flow::Progress& progress) override { _solver.restore(progress); }
  flow::Stop advance(double target, std::int64_t pause_step, const flow::Poll& poll) override {
    return _solver.advance(target, pause_step, poll);
  }
  flow::Progress progress() override { return _solver.flow().progress(); }
  flow::StepFailure failure() override { return _solver.flow().failure(); }
  flow::Totals totals() override { return _solver.flow().totals(); }
  flow::Extremes extremes() override { return _solver.flow().extremes(); }
  void set_extremes(const flow::Extremes& extremes) override { _solver.flow().set_extremes(extremes); }
  void sample(flow::CellField field, std::span<double> values) override {
    _solver.flow().sample(field, values);
  }
  [[nodiscard]] std::optional<flow::PressureSolve> last_pressure_solve() const override {
    return _solver.flow().last_pressure_solve();
  }
  [[nodiscard]] const char* driver() const override { return _solver.flow().driver(); }
  [[nodiscard]] const char* pressure_solver() const override { return _solver.flow().pressure_solver(); }

  void upload_cloth(std::span<const fabric::Vector> positions,
                    std::span<const fabric::Vector> velocities) override {
    _solver.fabric().upload(positions, velocities);
  }
  void download_cloth(std::span<fabric::Vector> positions, std::span<fabric::Vector> velocities) override {
    _solver.fabric().download(positions, velocities);
  }
  std::array<double, 3> total_force_on_air() override { return _solver.total_force_on_air(); }
  void air_velocity(std::span<fabric::Vector> at_vertices) override {
    if (at_vertices.size() != static_cast<std::size_t>(_solver.fabric().vertices()))
      throw std::invalid_argument("coupled solver: there must be one vector per vertex");
    _reader.read(_instance.space(), _solver.air_velocity(), at_vertices);
  }
  void elastic_forces(std::span<fabric::Vector> on_vertices) override {
    _solver.fabric().forces(on_vertices);
  }
  void cloth_stress(fabric::StressMeasure measure, std::span<fabric::Stress> of_triangles) override {
    _solver.fabric().stress(measure, of_triangles);
  }
  [[nodiscard]] std::vector<stepping::StateArray> state() const override { return _solver.state(); }
  void upload(std::string_view name, std::span<const double> values) override {
    _solver.upload(name, values);
  }
  void download(std::string_view name, std::span<double> values) override { _solver.download(name, values); }
  [[nodiscard]] BlockProgress block() const override { return _solver.block(); }
  void set_block(const BlockProgress& block) override { _solver.set_block(block); }
  [[nodiscard]] FrameMotion frame() const override { return _solver.frame(); }
  void set_frame(const FrameMotion& frame) override { _solver.set_frame(frame); }
  void watch_pulls(std::span<const fabric::Pull> pulls) override { _solver.watch_pulls(pulls); }
  std::vector<fabric::PeakPull> peak_pulls() override { return _solver.peak_pulls(); }
  void set_peak_pulls(std::span<const fabric::PeakPull> peaks) override { _solver.set_peak_pulls(peaks); }
  fabric::Totals cloth_totals() override { return _solver.fabric().totals(); }
  FailureReason failure_reason() override { return _solver.failure_reason(); }
  int failed_line() override { return _solver.failed_line(); }
  std::optional<fabric::StepFailure> cloth_failure() override { return _solver.cloth_failure(); }

 private:
  fabric::PointsReader<ExecutionSpace> _reader;
  device::Instance<ExecutionSpace> _instance;
  CoupledSolver<ExecutionSpace> _solver;
};

/// Facade of a solver on `ExecutionSpace`. Throws as the constructor of CoupledSolver does.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters, const linear::RankGroup& group) {
  return std::make_unique<SolverAdapter<ExecutionSpace>>(parameters, group);
}

}  // namespace drogue::coupling
