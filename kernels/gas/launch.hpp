#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/device/persistent_kernel.hpp"
#include "kernels/gas/control.hpp"
#include "kernels/gas/tile.hpp"
#include "kernels/gas/weno.hpp"

namespace drogue::gas {

/// What the kernels of one solver's steps share.
template <class ExecutionSpace>
struct StageSetup {
  FieldsView<ExecutionSpace> buffer[3];
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> touched;
  StageTable table;
  Ends ends;
  TileShape stage_shape, step_shape;
  int team_size;
  double gamma, dx;
  Splitting splitting;
  Mean mean;
};

/// Threads of a team that has a multiprocessor for itself, each with 168 registers.
inline constexpr int largest_persistent_team = 384;

/// What steps that share a launch need beside it.
template <class ExecutionSpace>
struct PersistentSetup {
  device::PersistentKernel<ExecutionSpace> grid;
  TileShape shape;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
};

/// Enqueues stage `stage` of a step. Defined in launch_tiles.hpp, instantiated in
/// instances/stage.cpp and instances/step.cpp.
template <Reconstruction scheme, class ExecutionSpace>
void launch_stage(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                  bool limited, int stage);

/// Enqueues all stages of a step at once: with alpha from the stencil.
template <Reconstruction scheme, class ExecutionSpace>
void launch_step(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                 bool limited);

/// Enqueues one launch of up to `most_steps` steps: with alpha from the stencil, and without the limiter.
template <Reconstruction scheme, class ExecutionSpace>
void launch_persistent_steps(const StageSetup<ExecutionSpace>& setup,
                             const PersistentSetup<ExecutionSpace>& persistent, Precision precision,
                             std::int64_t most_steps);

}  // namespace drogue::gas
