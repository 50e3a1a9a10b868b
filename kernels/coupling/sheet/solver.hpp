#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::coupling {

/// Reason why a step of cloth in air failed.
enum class FailureReason {
  flow,         ///< the flow failed: `flow::Solver::failure` has the reason
  cloth,        ///< the state of the cloth is not finite, or its contact failed
  left_domain,  ///< the air around a vertex extends beyond a side of the domain
  not_spread,   ///< a force on the air is not finite or larger than 1e270 N
  too_stiff,    ///< the cloth needs more than `most_substeps` steps in a step of the flow
  line,         ///< a line carries more than its strength: `Solver::failed_line` has its number
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

/// Cloth in incompressible flow on a backend that a program chooses at run time. Needs an initialised
/// runtime. To couple other kernels on the device, use `CoupledSolver`.
///
/// The functions of the base class refer to the flow; `advance` moves both. With `Parameters::follow`, all
/// velocities and positions are relative to a moving frame. Call `upload_cloth` and `upload`,
/// then `start`; or restore all arrays of both, then `restore`. After a failed step, the state of both is
/// that before the step of the flow.
///
/// On a group of several ranks each holds a part of the cells, as those of `flow::create_solver`, and the
/// whole cloth, which is the same on all: each rank gives the same positions, velocities and accelerations,
/// and reads those of all vertices.
class Solver : public flow::Solver {
 public:
  /// Sets positions, m, and velocities, m/s, of all vertices. Throws std::invalid_argument for values that
  /// are not finite and spans of the wrong length.
  virtual void upload_cloth(std::span<const fabric::Vector> positions,
                            std::span<const fabric::Vector> velocities) = 0;

  /// Copies positions, m, and velocities, m/s. Throws std::invalid_argument for spans of the wrong length.
  virtual void download_cloth(std::span<fabric::Vector> positions, std::span<fabric::Vector> velocities) = 0;

  /// Arrays of the state of the cloth and of the air beside it, with which and with those of the flow, the
  /// progress, the block and the frame, an equal solver continues bit for bit. Does not throw.
  [[nodiscard]] virtual std::vector<stepping::StateArray> state() const = 0;

  /// Restores an array of `state`, in its unit, after `restore`. Throws std::invalid_argument for an unknown
  /// name, a span of the wrong length, and positions and velocities that are not finite.
  virtual void upload(std::string_view name, std::span<const double> values) = 0;
  using flow::Solver::upload;

  /// Copies an array of `state`, or "sheet_force": the forces of the vertices on the air, N, mean over the
  /// last step of the flow, which is a part of the state with explicit coupling alone. Throws
  /// std::invalid_argument for an unknown name and a span of the wrong length.
  virtual void download(std::string_view name, std::span<double> values) = 0;
  using flow::Solver::download;

  /// Block of the present step. Does not throw.
  [[nodiscard]] virtual BlockProgress block() const = 0;

  /// Restores the block, after `restore`. Does not throw.
  virtual void set_block(const BlockProgress& block) = 0;

  /// Motion of the frame of reference; at rest unless `Parameters::follow` has a vertex. Does not throw.
  [[nodiscard]] virtual FrameMotion frame() const = 0;

  /// Restores the motion of the frame of reference, after `restore`. Throws std::invalid_argument for a
  /// velocity along an axis that the frame does not follow.
  virtual void set_frame(const FrameMotion& frame) = 0;

  /// Total of the force densities that act on the air in the last step of the flow, N: the sum of
  /// "sheet_force" to round-off. Throws only after a failed kernel.
  [[nodiscard]] virtual std::array<double, 3> total_force_on_air() = 0;

  /// Velocity of the air, m/s, interpolated to the present positions of all vertices. Throws
  /// std::invalid_argument for a span of the wrong length.
  virtual void air_velocity(std::span<fabric::Vector> at_vertices) = 0;

  /// Elastic forces on the vertices at the present positions, N, without those of the air and gravity. Throws
  /// std::invalid_argument for a span of the wrong length.
  virtual void elastic_forces(std::span<fabric::Vector> on_vertices) = 0;

  /// Stress of every triangle at the present positions, N/m. Throws std::invalid_argument for a span of the
  /// wrong length.
  virtual void cloth_stress(fabric::StressMeasure measure, std::span<fabric::Stress> of_triangles) = 0;

  /// Energies and momenta of the cloth. Throws only after a failed kernel.
  [[nodiscard]] virtual fabric::Totals cloth_totals() = 0;

  /// Records the largest forces of lines on vertices, N, at the start and the end of every step of the flow,
  /// on the device. Call it before `start`, or before `restore` and `set_peak_pulls`. Replaces former pulls.
  /// Throws std::invalid_argument for lines that do not end at their vertex.
  virtual void watch_pulls(std::span<const fabric::Pull> pulls) = 0;

  /// Peaks of the pulls that are watched. Throws only after a failed kernel.
  [[nodiscard]] virtual std::vector<fabric::PeakPull> peak_pulls() = 0;

  /// Restores the peaks, N and s. Throws std::invalid_argument for another number than that of the pulls.
  virtual void set_peak_pulls(std::span<const fabric::PeakPull> peaks) = 0;

  /// Reason of the failure that ended the last `advance` with `Stop::failed`. Throws only after a failed
  /// kernel.
  [[nodiscard]] virtual FailureReason failure_reason() = 0;

  /// Number of the line whose tension has ended `advance`: the first one in the mesh. Throws only after a
  /// failed kernel.
  [[nodiscard]] virtual int failed_line() = 0;

  /// Step of the cloth that has ended `advance`, if its cloth did, with reason and vertex. Does not throw.
  [[nodiscard]] virtual std::optional<fabric::StepFailure> cloth_failure() = 0;
};

/// Solver on a backend, which must be available. Blocks. Throws std::invalid_argument for parameters out of
/// range, and std::bad_alloc if memory runs out.
///
/// On a group of several ranks `total_force_on_air`, `air_velocity` and `set_frame` are collective, as are
/// the functions of the flow; `create_solver` throws std::invalid_argument also if the ranks cannot share the
/// grid.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters,
                                                    const linear::RankGroup& group = {});

}  // namespace drogue::coupling
