#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/program/communicator.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/flow/halo/decomposition.hpp"

namespace drogue::parachute_app {

/// Requests of rank 0 to the other ranks. An empty message ends them.
enum class Request : int {
  create,           ///< backend and parameters: a solver on all ranks
  destroy,          ///< the solver
  upload,           ///< field: rank 0 sends the parts of an array of the state
  upload_function,  ///< axis, text: a component of the velocity, evaluated by each rank
  start,
  restore,  ///< progress
  advance,  ///< target time, pause step
  totals,
  download,      ///< field: rank 0 receives the parts
  sample,        ///< field: rank 0 receives the parts
  write,         ///< field, offset, file: all ranks write a field
  upload_cloth,  ///< positions and velocities of all vertices
  upload_array,  ///< name of an array of the cloth, and its values
  set_block,     ///< block
  set_frame,     ///< motion
  total_force_on_air,
  air_velocity,
};

/// The solver on one of several ranks, with the transfer of arrays between rank 0 and the others. Each rank
/// has all vertices of the cloth. All functions are collective and block. An exception from a kernel or from
/// lack of memory ends all ranks, because the others wait within a step.
class RankSolver {
 public:
  /// Calls `prepare` first. Without vertices of cloth the solver is that of the flow alone. Throws `Failure`
  /// on all ranks if something fails on one.
  RankSolver(Communicator& communicator, device::Backend backend, const coupling::Parameters& parameters,
             const std::function<void()>& prepare);

  [[nodiscard]] flow::Solver& solver() { return *_solver; }
  /// Not without vertices of cloth.
  [[nodiscard]] coupling::Solver& coupled() { return *_coupled; }

  /// Rank 0 gives the whole array; the span is not used elsewhere.
  void upload(flow::StateField field, std::span<const double> whole);
  /// Each rank evaluates the expression at its own points at time 0 s.
  void upload_function(std::size_t axis, const std::string& text);
  /// Rank 0 receives the whole array; the span is not used elsewhere.
  void download(flow::StateField field, std::span<double> whole);
  /// As `download`, in the order of `flow::Solver::sample`.
  void sample(flow::CellField field, std::span<double> whole);
  /// Writes a field in that order from byte `offset` of a file on. Throws `Failure` (io_error) on all ranks
  /// if one fails.
  void write(flow::CellField field, std::uint64_t offset, const std::string& file);

  /// Runs an action of the solver; ends all ranks if it throws.
  template <class Action>
  auto run(const Action& action) {
    try {
      return action();
    } catch (...) {
      _communicator.abort();
    }
  }

 private:
  /// Extents and begin of the part of a rank, fastest axis first.
  struct Part {
    std::array<std::size_t, 4> begin, extent;
    [[nodiscard]] std::size_t size() const { return extent[0] * extent[1] * extent[2] * extent[3]; }
  };
  [[nodiscard]] linear::CellBox box(flow::StateField field, int rank) const;
  [[nodiscard]] Part state_part(flow::StateField field, int rank) const;
  [[nodiscard]] Part sample_part(flow::CellField field, int rank) const;
  template <class PartOf>
  void collect(const std::vector<double>& own, std::span<double> whole, const Part& shape,
               const PartOf& part_of) const;

  Communicator& _communicator;
  flow::Parameters _parameters;
  linear::RankGroup _group;
  std::unique_ptr<flow::Solver> _solver;
  coupling::Solver* _coupled = nullptr;  ///< `_solver` with cloth
};

/// Solver whose cells all ranks share, as rank 0 uses it: arrays are those of the whole grid. Functions as of
/// `coupling::Solver`; without vertices of cloth only those of `flow::Solver`.
class SharedSolver final : public coupling::Solver {
 public:
  /// Throws `Failure`: usage if the ranks cannot share the grid; otherwise as `RankSolver`.
  SharedSolver(Communicator& communicator, device::Backend backend, const coupling::Parameters& parameters);
  ~SharedSolver() override;

  /// Sets a component of the velocity, m/s, to an expression of x, y, z and t at time 0 s.
  void upload(std::size_t axis, const std::string& text);

  /// Writes a field, in the order of `sample`, from byte `offset` of a file on: each rank its part. Throws
  /// `Failure` (io_error).
  void write(flow::CellField field, std::uint64_t offset, const std::string& file);

  void upload(flow::StateField field, std::span<const double> values) override;
  void download(flow::StateField field, std::span<double> values) override;
  void start() override;
  void restore(const flow::Progress& progress) override;
  flow::Stop advance(double target, std::int64_t pause_step, const flow::Poll& poll) override;
  [[nodiscard]] flow::Progress progress() override { return _own->solver().progress(); }
  [[nodiscard]] flow::StepFailure failure() override { return _own->solver().failure(); }
  [[nodiscard]] flow::Totals totals() override;
  // All ranks have the same.
  [[nodiscard]] flow::Extremes extremes() override { return _own->solver().extremes(); }
  void set_extremes(const flow::Extremes& extremes) override { _own->solver().set_extremes(extremes); }
  void sample(flow::CellField field, std::span<double> values) override;
  [[nodiscard]] const char* driver() const override { return _own->solver().driver(); }
  [[nodiscard]] const char* pressure_solver() const override { return _own->solver().pressure_solver(); }
  [[nodiscard]] std::optional<flow::PressureSolve> last_pressure_solve() const override {
    return _own->solver().last_pressure_solve();
  }

  void upload_cloth(std::span<const fabric::Vector> positions,
                    std::span<const fabric::Vector> velocities) override;
  void upload(std::string_view name, std::span<const double> values) override;
  void set_block(const coupling::BlockProgress& block) override;
  void set_frame(const coupling::FrameMotion& frame) override;
  [[nodiscard]] std::array<double, 3> total_force_on_air() override;
  void air_velocity(std::span<fabric::Vector> at_vertices) override;
  // Rank 0 has the whole cloth.
  void download_cloth(std::span<fabric::Vector> positions, std::span<fabric::Vector> velocities) override {
    _own->coupled().download_cloth(positions, velocities);
  }
  // Sharp sheets, which have an array of the faces, work on one rank.
  [[nodiscard]] std::vector<stepping::StateArray> state() const override { return _own->coupled().state(); }
  void download(std::string_view name, std::span<double> values) override {
    _own->coupled().download(name, values);
  }
  [[nodiscard]] coupling::BlockProgress block() const override { return _own->coupled().block(); }
  [[nodiscard]] coupling::FrameMotion frame() const override { return _own->coupled().frame(); }
  void elastic_forces(std::span<fabric::Vector> on_vertices) override {
    _own->coupled().elastic_forces(on_vertices);
  }
  void cloth_stress(fabric::StressMeasure measure, std::span<fabric::Stress> of_triangles) override {
    _own->coupled().cloth_stress(measure, of_triangles);
  }
  [[nodiscard]] fabric::Totals cloth_totals() override { return _own->coupled().cloth_totals(); }
  void watch_pulls(std::span<const fabric::Pull> pulls) override { _own->coupled().watch_pulls(pulls); }
  [[nodiscard]] std::vector<fabric::PeakPull> peak_pulls() override { return _own->coupled().peak_pulls(); }
  void set_peak_pulls(std::span<const fabric::PeakPull> peaks) override {
    _own->coupled().set_peak_pulls(peaks);
  }
  [[nodiscard]] coupling::FailureReason failure_reason() override { return _own->coupled().failure_reason(); }
  [[nodiscard]] int failed_line() override { return _own->coupled().failed_line(); }
  [[nodiscard]] std::optional<fabric::StepFailure> cloth_failure() override {
    return _own->coupled().cloth_failure();
  }

 private:
  template <class... Values>
  void request(Request request, const Values&... values);
  void request_with(Request request, std::initializer_list<std::span<const fabric::Vector>> arrays);

  Communicator& _communicator;
  std::unique_ptr<RankSolver> _own;
};

}  // namespace drogue::parachute_app
