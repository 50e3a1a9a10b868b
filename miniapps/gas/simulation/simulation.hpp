#pragma once

#include <memory>

#include "kernels/gas/solver.hpp"
#include "miniapps/framework/simulation.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Counts of the positivity limiter.
struct LimiterCounts {
  std::int64_t limited_faces = 0;  ///< summed over all stages
  std::int64_t limited_cells = 0;  ///< cells with a limited face at least once
  std::int64_t redone_steps = 0;
};

/// Sets the group `limiter` of result.json. Does not throw.
void set_limiter_metrics(const LimiterCounts& counts, run::Metrics& metrics);

/// Columns of history.csv after the time.
[[nodiscard]] std::vector<run::Column> history_columns();

/// A scene on a solver. Functions as of `framework::Simulation`.
class Simulation final : public framework::Simulation {
 public:
  /// Keeps a reference to `scene`. Throws `Failure` (no_backend, numerical_failure).
  Simulation(const GasScene& scene, const framework::SimulationSettings& settings);

  [[nodiscard]] const framework::OutputRequest& output() const override { return _scene.output; }
  [[nodiscard]] framework::EndTime end_time() const override { return {_scene.end_time, "run.end_time"}; }
  void start() override;
  void restore(const run::RestartReader& reader) override;
  void write_restart(run::RestartWriter& writer) override;
  [[nodiscard]] framework::SimulationTime now() override;
  framework::StopReason advance(const framework::AdvanceLimits& limits, const framework::RowSink& rows,
                                const framework::Poll& poll) override;
  [[nodiscard]] std::vector<run::Column> history_columns() const override {
    return gas_app::history_columns();
  }
  [[nodiscard]] framework::HistoryRow row() override;
  [[nodiscard]] std::vector<run::DatasetSpec> field_specs() const override;
  void write_mesh(run::FieldSink& fields) const override;
  /// The solver holds one snapshot.
  [[nodiscard]] std::size_t snapshot_buffers() const override { return 1; }
  [[nodiscard]] framework::FieldsTask snapshot() override;
  [[nodiscard]] std::string failure_text(bool restart_written) override;
  void describe(run::ResultDocument& result) override;
  [[nodiscard]] run::ResultDocument::WallTimes phases() const override;
  [[nodiscard]] framework::StepWork step_work() const override;
  ExitCode verify(const run::RunDirectory* directory, run::ResultDocument& result) override;

  /// Largest relative change of mass, momentum and energy that the boundary fluxes do not explain.
  [[nodiscard]] double conservation();

  [[nodiscard]] gas::Solver& solver() { return *_solver; }

 private:
  void allocate_snapshot();

  const GasScene& _scene;
  framework::SimulationSettings _settings;
  std::unique_ptr<gas::Solver> _solver;
  gas::HistoryRow _initial;  ///< totals at the start of the first run
  gas::Stop _stop = gas::Stop::target;
  double _compute_s = 0.0, _h2d_s = 0.0;
};

/// Name of the precision in result.json: `double` or `split`.
[[nodiscard]] std::string precision_name(const gas::Parameters& parameters);

/// Dataset of a field of fields.h5: `rho`, `u` or `p` at `cells` cells.
[[nodiscard]] run::DatasetSpec field_spec(const std::string& name, std::int64_t cells);

/// Dataset of the cell centres.
[[nodiscard]] run::DatasetSpec cell_centre_spec(std::int64_t cells);

}  // namespace drogue::gas_app
