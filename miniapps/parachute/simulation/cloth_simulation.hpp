#pragma once

#include <memory>
#include <optional>

#include "kernels/coupling/sheet/line_cuts.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/stepping/batch_length.hpp"
#include "miniapps/framework/fabric_run.hpp"
#include "miniapps/framework/simulation.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "miniapps/parachute/simulation/history_columns.hpp"
#include "miniapps/parachute/simulation/sheet_output.hpp"
#include "miniapps/parachute/verify/peak_pulls.hpp"

namespace drogue::parachute_app {

/// The cloth of a scene without a fluid. Throws `Failure` (invalid_scene) as `make_all_sheets`.
[[nodiscard]] Sheets cloth_sheets(const FlowScene& scene);

/// A scene without a fluid on a solver of cloth. Functions as of `framework::Simulation`.
///
/// Steps of velocity Verlet come in blocks of at most 256 with the same dt, which end at outputs and cuts of
/// lines.
class ClothSimulation final : public framework::Simulation {
 public:
  /// Keeps a reference to `scene`. Throws `Failure` (no_backend, usage).
  ClothSimulation(const FlowScene& scene, const framework::SimulationSettings& settings);

  [[nodiscard]] const framework::OutputRequest& output() const override { return _scene.output; }
  [[nodiscard]] framework::EndTime end_time() const override { return {_scene.end_time, "run.end_time"}; }
  void start() override;
  void restore(const run::RestartReader& reader) override;
  void write_restart(run::RestartWriter& writer) override;
  [[nodiscard]] framework::SimulationTime now() override { return _plan.now(_solver->time_state()); }
  framework::StopReason advance(const framework::AdvanceLimits& limits, const framework::RowSink& rows,
                                const framework::Poll& poll) override;
  [[nodiscard]] std::vector<run::Column> history_columns() const override {
    return parachute_app::history_columns(_scene);
  }
  [[nodiscard]] framework::HistoryRow row() override;
  [[nodiscard]] std::vector<run::DatasetSpec> field_specs() const override;
  void write_mesh(run::FieldSink& fields) const override;
  [[nodiscard]] framework::FieldsTask snapshot() override;
  [[nodiscard]] std::string failure_text(bool restart_written) override;
  void describe(run::ResultDocument& result) override;
  [[nodiscard]] run::ResultDocument::WallTimes phases() const override;
  [[nodiscard]] framework::StepWork step_work() const override;
  ExitCode verify(const run::RunDirectory* directory, run::ResultDocument& result) override;

 private:
  void allocate_buffers();
  [[nodiscard]] bool plan(double target);
  [[nodiscard]] std::int64_t steps_to_event(const framework::AdvanceLimits& limits) const;
  [[nodiscard]] bool take_steps(std::int64_t steps);
  void return_to_checkpoint();
  [[nodiscard]] SheetState sheet_state();

  const FlowScene& _scene;
  Sheets _sheets;
  Airstream _airstream;
  coupling::LineCuts _cuts;
  std::unique_ptr<fabric::Solver> _solver;
  PeakPulls _peaks;
  framework::StepPlan _plan;
  std::optional<fabric::StepFailure> _failure;
  double _stable_dt = 0.0;  ///< s, at the begin of the block
  stepping::BatchLength _batch;
  double _compute_s = 0.0, _h2d_s = 0.0;
};

}  // namespace drogue::parachute_app
