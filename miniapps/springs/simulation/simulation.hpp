#pragma once

#include <map>
#include <memory>
#include <optional>

#include "kernels/fabric/solver.hpp"
#include "kernels/stepping/batch_length.hpp"
#include "miniapps/framework/fabric_run.hpp"
#include "miniapps/framework/simulation.hpp"
#include "miniapps/springs/simulation/problem.hpp"
#include "miniapps/springs/simulation/stress_fields.hpp"
#include "miniapps/springs/verify/verify.hpp"

namespace drogue::springs_app {

/// Energies, momenta and probe positions of one state.
struct StateTotals {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J
  fabric::Vector momentum{};                             ///< kg m/s
  fabric::Vector angular_momentum{};                     ///< kg m^2/s
  std::vector<fabric::Vector> probes;                    ///< positions, m
  double contact_work = 0.0;                             ///< J, without friction
  double friction_work = 0.0;                            ///< J
  int intersections = 0;
};

/// A scene on a solver. Functions as of `framework::Simulation`; vertices are in the scene's numbering.
class Simulation final : public framework::Simulation {
 public:
  /// Keeps a reference to `scene`. Throws `Failure` (no_backend).
  Simulation(const SpringsScene& scene, const framework::SimulationSettings& settings);

  [[nodiscard]] const framework::OutputRequest& output() const override { return _scene.output; }
  [[nodiscard]] framework::EndTime end_time() const override {
    return {_scene.time.end_time, "time.end_time"};
  }
  void start() override;
  void restore(const run::RestartReader& reader) override;
  void write_restart(run::RestartWriter& writer) override;
  [[nodiscard]] framework::SimulationTime now() override { return _plan.now(_solver->time_state()); }
  framework::StopReason advance(const framework::AdvanceLimits& limits, const framework::RowSink& rows,
                                const framework::Poll& poll) override;
  bool plan_next_interval() override;
  [[nodiscard]] std::vector<run::Column> history_columns() const override;
  [[nodiscard]] framework::HistoryRow row() override;
  [[nodiscard]] std::vector<run::DatasetSpec> field_specs() const override;
  void write_mesh(run::FieldSink& fields) const override;
  [[nodiscard]] framework::FieldsTask snapshot() override;
  [[nodiscard]] std::string failure_text(bool restart_written) override;
  void describe(run::ResultDocument& result) override;
  [[nodiscard]] run::ResultDocument::WallTimes phases() const override;
  [[nodiscard]] framework::StepWork step_work() const override;
  ExitCode verify(const run::RunDirectory* directory, run::ResultDocument& result) override;

  /// Totals of the current state, and the work done so far. Blocks.
  [[nodiscard]] StateTotals totals();

  /// Positions of the vertices, m. Blocks.
  [[nodiscard]] std::vector<fabric::Vector> positions();

 private:
  void plan();
  void replan_if_stiffer();
  [[nodiscard]] double fastest_frequency();
  [[nodiscard]] double longest_stable_step(double frequency);
  [[nodiscard]] double stable_dt();
  [[nodiscard]] std::string too_long_step();
  [[nodiscard]] std::int64_t steps_to_event(const framework::AdvanceLimits& limits) const;
  [[nodiscard]] bool take_steps(std::int64_t steps, const framework::Poll& poll);
  void round_trip();
  void return_to_last_good(std::int64_t lost);
  [[nodiscard]] double time() const { return _plan.now(_solver->time_state()).time; }
  [[nodiscard]] std::vector<fabric::Stress> stress_of(const StressKind& kind);
  [[nodiscard]] FinalState final_state();

  const SpringsScene& _scene;
  framework::SimulationSettings _settings;
  Problem _problem;
  const double _pressure;  ///< Pa, with a potential
  std::unique_ptr<fabric::Solver> _solver;
  framework::StepPlan _plan;
  std::optional<std::string> _too_long;  ///< why the step is too long, empty if it is not; none: unchecked
  std::optional<fabric::StepFailure> _failure;
  double _checked_frequency = 0.0;  ///< 1/s, bound of the frequencies at the last search for the largest
  stepping::BatchLength _batch;
  double _compute_s = 0.0, _h2d_s = 0.0, _d2h_s = 0.0, _bound_s = 0.0;
};

}  // namespace drogue::springs_app
