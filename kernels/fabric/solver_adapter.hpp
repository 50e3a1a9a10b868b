#pragma once

#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/fabric/host_threads.hpp"

namespace drogue::fabric {

/// `FabricSolver` behind the virtual interface, on an execution-space instance of its own.
template <class ExecutionSpace>
class SolverAdapter final : public Solver {
 public:
  explicit SolverAdapter(const Parameters& p)
      : _instance(host_threads(p.mesh.rest.size())), _solver(_instance.space(), p) {}

  void upload(std::span<const Vector> positions, std::span<const Vector> velocities) override {
    _solver.upload(positions, velocities);
  }
  void download(std::span<Vector> positions, std::span<Vector> velocities) override {
    _solver.download(positions, velocities);
  }
  bool advance(std::int64_t steps) override { return _solver.enqueue_steps(steps); }
  std::optional<StepFailure> failure() override { return _solver.failure(); }
  [[nodiscard]] TimeState time_state() const override { return _solver.time_state(); }
  void set_time_state(const TimeState& time) override { _solver.set_time_state(time); }
  void forces(std::span<Vector> forces) override { _solver.forces(forces); }
  double fastest_frequency() override { return _solver.fastest_frequency(); }
  double frequency_at_least() override { return _solver.frequency_at_least(); }
  [[nodiscard]] double fastest_decay() const override { return _solver.fastest_decay(); }
  void stress(StressMeasure measure, std::span<Stress> of_triangles) override {
    _solver.stress(measure, of_triangles);
  }
  void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) override {
    _solver.vertex_stress(measure, of_vertices);
  }
  Totals totals() override { return _solver.totals(); }
  void set_line_stiffness(std::span<const double> of_lines) override { _solver.set_line_stiffness(of_lines); }
  void watch_pulls(std::span<const Pull> pulls) override { _solver.watch_pulls(pulls); }
  std::vector<PeakPull> peak_pulls() override { return _solver.peak_pulls(); }
  void set_peak_pulls(std::span<const PeakPull> peaks) override { _solver.set_peak_pulls(peaks); }
  [[nodiscard]] const char* driver() const override { return _solver.driver(); }
  void contact_work(std::span<ContactWork> of_vertices) override { _solver.contact_work(of_vertices); }
  void set_contact_work(std::span<const ContactWork> of_vertices) override {
    _solver.set_contact_work(of_vertices);
  }

 private:
  device::Instance<ExecutionSpace> _instance;
  FabricSolver<ExecutionSpace> _solver;
};

/// Facade of a solver on `ExecutionSpace`. Throws as the constructor of FabricSolver does.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters) {
  return std::make_unique<SolverAdapter<ExecutionSpace>>(parameters);
}

}  // namespace drogue::fabric
