#pragma once

#include <array>
#include <functional>
#include <memory>

#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/flow/solver.hpp"
#include "miniapps/framework/simulation.hpp"
#include "miniapps/parachute/bodies/inside_fluid.hpp"
#include "miniapps/parachute/canopy/image_watch.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "miniapps/parachute/simulation/grid_parts.hpp"
#include "miniapps/parachute/simulation/history_columns.hpp"
#include "miniapps/parachute/simulation/sheet_output.hpp"
#include "miniapps/parachute/verify/peak_pulls.hpp"
#include "miniapps/parachute/verify/statistics.hpp"

namespace drogue::parachute_app {

/// A scene on a solver. Functions as of `framework::Simulation`.
class Simulation final : public framework::Simulation {
 public:
  /// Keeps a reference to `scene`. Throws `Failure` (usage) if ranks cannot share it, alike on all of them.
  Simulation(const FlowScene& scene, const framework::SimulationSettings& settings);

  [[nodiscard]] const framework::OutputRequest& output() const override { return _scene.output; }
  [[nodiscard]] framework::EndTime end_time() const override { return {_scene.end_time, "run.end_time"}; }
  void start() override;
  void restore(const run::RestartReader& reader) override;
  void write_restart(run::RestartWriter& writer) override;
  [[nodiscard]] framework::SimulationTime now() override;
  framework::StopReason advance(const framework::AdvanceLimits& limits, const framework::RowSink& rows,
                                const framework::Poll& poll) override;
  [[nodiscard]] std::vector<run::Column> history_columns() const override {
    return parachute_app::history_columns(_scene);
  }
  [[nodiscard]] framework::HistoryRow row() override;
  [[nodiscard]] std::vector<run::DatasetSpec> field_specs() const override;
  void write_mesh(run::FieldSink& fields) const override;
  [[nodiscard]] std::size_t snapshot_buffers() const override { return _snapshots.size(); }
  [[nodiscard]] bool writes_on_calling_thread() const override { return _parts.group().size() > 1; }
  [[nodiscard]] framework::FieldsTask snapshot() override;
  [[nodiscard]] std::string failure_text(bool restart_written) override;
  void describe(run::ResultDocument& result) override;
  [[nodiscard]] run::ResultDocument::WallTimes phases() const override;
  [[nodiscard]] framework::StepWork step_work() const override;
  ExitCode verify(const run::RunDirectory* directory, run::ResultDocument& result) override;

  /// Errors against the exact solution of the scene at the present time, by the names of the tolerances. On
  /// several ranks collective. Throws std::bad_optional_access without an exact solution.
  [[nodiscard]] std::map<std::string, double> error_norms();

  /// Root-mean-square divergence of the present state, 1/s.
  [[nodiscard]] double divergence() { return _solver->totals().divergence_rms; }

  [[nodiscard]] flow::Solver& solver() { return *_solver; }

 private:
  /// Values of the fields of one output, in the order of the scene, then positions of grids that move.
  using Snapshot = std::vector<std::vector<double>>;

  /// What a row of the history needs of the device: of the sheets, what the columns of the scene ask for.
  struct RowState {
    flow::Totals flow;
    coupling::Progress progress;
    SheetState sheets;
    fabric::Totals fabric;    ///< with canopies
    fabric::Vector on_air{};  ///< total force, with canopies, N
  };

  framework::StopReason take_steps(const framework::AdvanceLimits& limits,
                                   const std::function<void()>& begin_row, const framework::Poll& poll);
  [[nodiscard]] RowState row_state();
  [[nodiscard]] framework::HistoryRow row_of(const RowState& state);
  [[nodiscard]] bool meets_image();
  void sample_fields(Snapshot& snapshot);
  [[nodiscard]] std::vector<double> download_whole(std::size_t axis);
  void check_profiles(run::ResultDocument& result);
  void check_totals(run::ResultDocument& result);
  [[nodiscard]] SheetState sheet_state();
  void append_body_values(const RowState& state, framework::HistoryRow& row);
  void append_canopy_values(const RowState& state, framework::HistoryRow& row) const;
  void append_flag_values(const SheetState& state, framework::HistoryRow& row) const;
  void sample_flow_field(flow::CellField field, std::span<double> values);
  void require_converged_pressure(flow::CellField field);
  [[nodiscard]] std::string residual_text(double residual) const;
  void sample_canopy_field(const std::string& name, std::vector<double>& values);
  void sample_positions(const SheetGrid& grid, std::vector<double>& values);
  [[nodiscard]] std::string failure_cause();
  [[nodiscard]] std::string flow_failure_text();
  [[nodiscard]] std::string lost_motion_text(const fabric::StepFailure& failure) const;
  [[nodiscard]] std::string sheet_failure_text(coupling::FailureReason reason);
  [[nodiscard]] std::string stiff_cloth_text();
  [[nodiscard]] std::string broken_line_text();
  [[nodiscard]] std::string leans_text(std::size_t vertex,
                                       const std::vector<fabric::Vector>& positions) const;
  [[nodiscard]] std::string leaving_vertex_text();
  [[nodiscard]] std::string leaving_part_text(std::size_t vertex, bool leaves_core) const;
  [[nodiscard]] std::string vertex_text(std::int64_t vertex) const;
  [[nodiscard]] std::string now_text();
  [[nodiscard]] const char* step_key() const;
  [[nodiscard]] std::string light_cloth_text() const;
  void write_coupling(run::RestartWriter& writer);
  void read_coupling(const run::RestartReader& reader, coupling::Progress& progress);

  const FlowScene& _scene;
  Communicator& _communicator;
  GridParts _parts;
  Sheets _sheets;
  Airstream _airstream;
  ImageWatch _images;
  std::optional<std::string> _met_image;       ///< what has ended the run
  std::vector<InsideFluid> _inside;            ///< of each body
  std::vector<SheetGrid> _grids;               ///< in fields.h5, beside flow and canopies
  std::unique_ptr<coupling::Solver> _coupled;  ///< with bodies, canopies or flags
  std::unique_ptr<flow::Solver> _alone;        ///< without
  flow::Solver* _solver = nullptr;             ///< the flow of either, for all but its steps
  RunStatistics _statistics;
  PeakPulls _peaks;
  /// Used in turn: one is written while the other is filled. Empty on several ranks.
  std::array<Snapshot, 2> _snapshots;
  std::size_t _next_snapshot = 0;
  flow::Stop _stop = flow::Stop::target;
  double _compute_s = 0.0, _h2d_s = 0.0;
};

}  // namespace drogue::parachute_app
