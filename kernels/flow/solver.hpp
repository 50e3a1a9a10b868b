#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/linear/parallel/rank_group.hpp"
#include "kernels/linear/parallel/transport.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::flow {

/// Incompressible flow on a backend that a program chooses at run time. Needs an initialised runtime. To
/// couple other kernels on the device, use `FlowSolver`.
///
/// Call `upload` for the three velocity components, then `start`; or `upload` for all arrays of the state,
/// then `restore`; then `advance` as often as needed. Functions block and are not thread-safe. A failed
/// kernel throws `std::runtime_error`. After a failed step, the state is that before the step.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Arrays of the state on this rank: "velocity_x" to "velocity_z" on the faces normal to an axis; with AB2
  /// "rate_x" to "rate_z", the rates of change without pressure of the previous step; "pressure", kinematic,
  /// at the cell centres, of the last step and of second order at its middle. The index along x varies
  /// fastest. With them and `Progress`, an equal solver continues bit for bit. Throws std::bad_alloc.
  [[nodiscard]] virtual std::vector<stepping::StateArray> state() const = 0;

  /// Sets an array of `state`, in its unit. Throws std::invalid_argument for an unknown name and a span of
  /// the wrong length.
  virtual void upload(std::string_view name, std::span<const double> values) = 0;

  /// Copies an array of `state`, in its unit. Throws as `upload` does.
  virtual void download(std::string_view name, std::span<double> values) = 0;

  /// Makes the uploaded velocity the initial state at time 0 s and step 0: sets the prescribed values on the
  /// sides and subtracts the gradient that makes the velocity free of divergence.
  virtual void start() = 0;

  /// Continues from uploaded arrays with the progress of an equal solver.
  virtual void restore(const Progress& progress) = 0;

  /// Steps until the time reaches `target` (s), the number of steps equals `pause_step` (-1: no pause), or
  /// the run stops. `poll` may be empty. Reports failures by the returned `Stop` and does not throw for them.
  virtual Stop advance(double target, std::int64_t pause_step, const Poll& poll) = 0;

  /// Progress after the last step.
  [[nodiscard]] virtual Progress progress() = 0;

  /// Failure that ended the last `advance` with `Stop::failed`.
  [[nodiscard]] virtual StepFailure failure() = 0;

  /// Sums over the present state. The order of summation does not depend on the backend.
  [[nodiscard]] virtual Totals totals() = 0;

  /// Extremes over all steps since `start`, with `Parameters::watches_extremes`; none without.
  [[nodiscard]] virtual Extremes extremes() = 0;

  /// Restores the extremes, after `restore`; on a group of several ranks those of this one. Throws
  /// std::invalid_argument if they are not watched.
  virtual void set_extremes(const Extremes& extremes) = 0;

  /// Field at the cell centres, in the SI unit that `CellField` states, in the order of an array of shape
  /// (nx, ny, nz) or (nx, ny, nz, 3) whose last index varies fastest. Throws std::invalid_argument for a span
  /// of the wrong length.
  virtual void sample(CellField field, std::span<double> values) = 0;

  /// Launch strategy: "graph" or "plain". Does not throw.
  [[nodiscard]] virtual const char* driver() const = 0;

  /// How messages between ranks travel. Does not throw.
  [[nodiscard]] virtual linear::Transport transport() const = 0;

  /// Last solve of an iterative pressure solver; none for a direct one. Does not throw.
  [[nodiscard]] virtual std::optional<PressureSolve> last_pressure_solve() const = 0;

  /// Name of the pressure solver: "fft" or "diagonalization" or "hypre-pfmg". Does not throw.
  [[nodiscard]] virtual const char* pressure_solver() const = 0;
};

/// Name of the array of the state that holds the velocity along an axis. Does not throw.
[[nodiscard]] inline std::string velocity_name(std::size_t axis) {
  return std::string("velocity_") + "xyz"[axis];
}

/// Indices along x, y and z from those of a `stepping::StateArray` of a flow, the last of which varies along
/// x. Does not throw.
[[nodiscard]] inline std::array<int, 3> x_first(const std::vector<std::size_t>& indices) {
  return {static_cast<int>(indices[2]), static_cast<int>(indices[1]), static_cast<int>(indices[0])};
}

/// In place of the axis that the faces of an array are normal to: its points are the cell centres.
inline constexpr std::size_t at_cells = 3;

/// Shape of a whole array, x first: the cells; on faces one more along the axis that they are normal to, if
/// it is not periodic and has more than one cell. Does not throw.
[[nodiscard]] std::array<int, 3> extents(const Parameters& parameters, std::size_t normal = at_cells);

/// Reason of a failed step in words, such as "the velocity is not finite". Does not throw.
[[nodiscard]] const char* failure_text(FailureReason reason);

/// Throws std::invalid_argument, with one sentence that names the fault, for parameters out of range or
/// boundary conditions that admit no solution.
void check_parameters(const Parameters& parameters);

/// Solver on a backend, which must be available. Throws std::invalid_argument as `check_parameters` does, and
/// std::bad_alloc if memory runs out.
///
/// On a group of several ranks each holds a part of the cells and of the arrays, and all functions but those
/// that do not throw are collective.
/// Throws std::invalid_argument also if the ranks cannot share the grid.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters,
                                                    const linear::RankGroup& group = {});

}  // namespace drogue::flow
