#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::coupling {

/// Reason why a step of cloth in air failed.
enum class FailureReason {
  flow,         ///< the flow failed: its `failure` has the reason
  cloth,        ///< the state of the cloth is not finite, or its contact failed
  left_domain,  ///< the air around a vertex extends beyond a side of the domain
  not_spread,   ///< a force on the air is not finite or larger than 1e270 N
  too_stiff,    ///< the cloth needs more than `most_substeps` steps in a step of the flow
  line,         ///< a line carries more than its strength
};

/// Division of a run into blocks of steps with constant dt, which end at targets too. A restart that restores
/// it continues bit for bit.
struct BlockProgress {
  double dt = 0.0;            ///< s, of the steps of the flow in the present block
  std::int64_t substeps = 0;  ///< steps of the cloth in each of them
  std::int64_t end = 0;       ///< step of the flow at which the block ends
  /// Steps of the cloth since `start`. It decides where launches of many steps end, of which one with a
  /// single step may round differently on a GPU.
  std::int64_t cloth_step = 0;
  /// Step of the cloth and time, s, from which its time is counted. It decides where bodies in prescribed
  /// motion are.
  std::int64_t since = 0;
  double start = 0.0;
};

/// Motion of the frame of reference of grid, velocities and positions. A restart that restores it continues
/// bit for bit.
struct FrameMotion {
  std::array<double, 3> velocity{};  ///< m/s, in the present block
  std::array<double, 3> start{};     ///< position of its origin at the time `since`, m
  double since = 0.0;                ///< s

  /// Position of the origin at a time, s, not before `since`, in m. Does not throw.
  [[nodiscard]] std::array<double, 3> position(double time) const {
    std::array<double, 3> result = start;
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] += (time - since) * velocity[axis];
    return result;
  }
};

/// Numbers of vectors, as an array of a state has them. Does not throw.
[[nodiscard]] inline std::span<double> numbers(std::vector<fabric::Vector>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), 3 * rows.size()};
}

/// Progress of cloth in air. A restart that restores it with the arrays of the state continues bit for bit.
struct Progress {
  flow::Progress flow;
  BlockProgress block;
  FrameMotion frame;  ///< at rest unless `Parameters::follow` has vertices
};

/// Failure that ended an `advance` with `flow::Stop::failed`.
struct StepFailure {
  FailureReason reason = FailureReason::flow;
  int line = -1;  ///< first one in the mesh that carries more than its strength; -1 for other reasons
  std::optional<fabric::StepFailure> cloth;  ///< step of the cloth with its own reason and vertex
};

/// Cloth in incompressible flow on a backend that a program chooses at run time. Needs an initialised
/// runtime. To couple other kernels on the device, use `CoupledSolver`, which is this class with the
/// functions that they need.
///
/// Upload the velocity to `flow` and positions and velocities to `fabric`, then call `start`; or restore all
/// arrays of the state of `flow` and of `state`, then call `restore`; then `advance`, which moves both. Steps
/// are those of this class alone: `start`, `restore`, `advance` and `enqueue_steps` of the parts are not to
/// be called. With `Parameters::follow`, all velocities and positions are relative to a moving frame. After a
/// failed step, the state of both is that before the step of the flow.
///
/// On a group of several ranks each holds a part of the cells, as those of `flow::create_solver`, and the
/// whole cloth, which is the same on all: each rank gives the same positions, velocities and accelerations,
/// and reads those of all vertices.
class Solver {
 public:
  virtual ~Solver() = default;

  /// The parts, for their states, fields, totals and failures. Does not throw.
  [[nodiscard]] virtual flow::Solver& flow() = 0;
  [[nodiscard]] virtual fabric::Solver& fabric() = 0;

  /// Makes the uploaded velocities and positions the initial state at time 0 s and step 0, as
  /// `flow::Solver::start`.
  virtual void start() = 0;

  /// Continues from uploaded arrays with the progress of an equal solver. Throws std::invalid_argument for
  /// positions and velocities that are not finite, and for a velocity of the frame along an axis that it does
  /// not follow.
  virtual void restore(const Progress& progress) = 0;

  /// As `flow::Solver::advance`.
  virtual flow::Stop advance(double target, std::int64_t pause_step, const flow::Poll& poll) = 0;

  /// Progress after the last step.
  [[nodiscard]] virtual Progress progress() = 0;

  /// Failure that ended the last `advance`. Throws only after a failed kernel.
  [[nodiscard]] virtual StepFailure failure() = 0;

  /// Arrays of the state of the cloth and of the air beside it, with which, with those of the flow and with
  /// the progress an equal solver continues bit for bit.
  [[nodiscard]] virtual std::vector<stepping::StateArray> state() const = 0;

  /// Sets an array of `state`, in its unit, for `restore`. Throws std::invalid_argument for an unknown name
  /// and a span of the wrong length.
  virtual void upload(std::string_view name, std::span<const double> values) = 0;

  /// Copies an array of `state`, or "sheet_force": the forces of the vertices on the air, N, mean over the
  /// last step of the flow, which is a part of the state with explicit coupling alone. Throws
  /// std::invalid_argument for an unknown name and a span of the wrong length.
  virtual void download(std::string_view name, std::span<double> values) = 0;

  /// Total of the force densities that act on the air in the last step of the flow, N: the sum of
  /// "sheet_force" to round-off. Throws only after a failed kernel.
  [[nodiscard]] virtual std::array<double, 3> total_force_on_air() = 0;

  /// Velocity of the air, m/s, interpolated to the present positions of all vertices. Throws
  /// std::invalid_argument for a span of the wrong length.
  virtual void air_velocity(std::span<fabric::Vector> at_vertices) = 0;

  /// Records the largest forces of lines on vertices, N, at the start and the end of every step of the flow,
  /// on the device. Call it before `start`, or before the upload of the state, to which the peaks belong
  /// then. Replaces former pulls. Throws std::invalid_argument for lines that do not end at their vertex.
  virtual void watch_pulls(std::span<const fabric::Pull> pulls) = 0;

  /// Peaks of the pulls that are watched. Throws only after a failed kernel.
  [[nodiscard]] virtual std::vector<fabric::PeakPull> peak_pulls() = 0;
};

/// Solver on a backend, which must be available. Blocks. Throws std::invalid_argument for parameters out of
/// range, and std::bad_alloc if memory runs out.
///
/// On a group of several ranks all functions are collective but those of the cloth, `state` and `download`;
/// `create_solver` throws std::invalid_argument also if the ranks cannot share the
/// grid.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters,
                                                    const linear::RankGroup& group = {});

}  // namespace drogue::coupling
