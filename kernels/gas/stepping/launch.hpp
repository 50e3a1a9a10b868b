#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/device/persistent_kernel.hpp"
#include "kernels/gas/flux/weno.hpp"
#include "kernels/gas/stepping/control.hpp"
#include "kernels/gas/tile/tile.hpp"

namespace drogue::gas {

/// Data that all step kernels of a solver share.
template <class ExecutionSpace>
struct StageSetup {
  FieldsView<ExecutionSpace> buffer[3];
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> limited_cells;
  StageTable table;
  BoundaryConditions boundaries;
  TileShape stage_shape, step_shape;
  int team_size;
  double gamma, dx;
  Splitting splitting;
  FaceAverage average;
};

/// Maximum threads of a team that occupies a multiprocessor alone, with 168 registers each.
inline constexpr int largest_persistent_team = 384;

/// Additional data of the persistent driver.
template <class ExecutionSpace>
struct PersistentSetup {
  device::PersistentKernel<ExecutionSpace> grid;
  TileShape shape;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
};

/// Enqueues stage `stage` of a step. Asynchronous. Throws std::runtime_error for a team that does not fit
/// the device. Defined in launch_tiles.hpp and instantiated in instances/stage.cpp.
template <Reconstruction scheme, class ExecutionSpace>
void launch_stage(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                  bool limited, int stage);

/// Enqueues all stages of a step as one kernel. Asynchronous. Requires `Splitting::lf_stencil`. Throws
/// std::runtime_error for a team that does not fit the device.
template <Reconstruction scheme, class ExecutionSpace>
void launch_step(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                 bool limited);

/// Enqueues one launch of up to `max_steps_per_launch` steps. Asynchronous. Requires `Splitting::lf_stencil`;
/// the limiter must be off. Throws std::runtime_error if the launch fails.
template <Reconstruction scheme, class ExecutionSpace>
void launch_persistent_steps(const StageSetup<ExecutionSpace>& setup,
                             const PersistentSetup<ExecutionSpace>& persistent, Precision precision,
                             std::int64_t max_steps_per_launch);

}  // namespace drogue::gas
