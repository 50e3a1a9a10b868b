#pragma once

#include "kernels/gas/launch.hpp"
#include "kernels/gas/stage.hpp"
#include "kernels/gas/step.hpp"

namespace drogue::gas {

/// Threads of a team for which a device thread has 168 registers: three teams a multiprocessor. With 96
/// registers and five teams the fused step spills and a mesh of 16 M cells took 1.2 times as long.
inline constexpr int team_of_full_registers = 128, largest_team = 512;

template <class Policy, class ExecutionSpace, class Functor>
void launch_tiles(const char* label, const ExecutionSpace& space, const TileShape& shape, std::int64_t tiles,
                  int team_size, const Functor& functor) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename Functor::Fields::memory_space>::accessible);
  Policy policy(space, static_cast<int>(tiles), team_size);
  policy.set_scratch_size(0,
                          Kokkos::PerTeam(static_cast<int>(Tile<ExecutionSpace>::scratch_bytes(shape) + 64)));
  // A light functor travels as a kernel argument; the other way, through constant memory, cannot be captured.
  Kokkos::parallel_for(
      label, Kokkos::Experimental::require(policy, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

template <class ExecutionSpace, class Functor>
void launch(const char* label, const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup,
            const TileShape& shape, const Functor& functor) {
  const std::int64_t tiles = (setup.ends.cells + shape.cells - 1) / shape.cells;
  if constexpr (device::is_host<ExecutionSpace>) {
    launch_tiles<Kokkos::TeamPolicy<ExecutionSpace>>(label, space, shape, tiles, setup.team_size, functor);
  } else {
    using Usual = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<team_of_full_registers, 3>>;
    using Large = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<largest_team, 1>>;
    if (setup.team_size <= team_of_full_registers)
      launch_tiles<Usual>(label, space, shape, tiles, setup.team_size, functor);
    else
      launch_tiles<Large>(label, space, shape, tiles, setup.team_size, functor);
  }
}

template <Reconstruction scheme, Precision precision, bool limited, class ExecutionSpace>
void launch_stage_as(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, int stage) {
  const bool last = stage == setup.table.stages - 1;
  const StageFunctor<ExecutionSpace, scheme, precision, limited> functor{
      {setup.buffer[0], setup.buffer[1], setup.buffer[2]},
      setup.control,
      setup.touched,
      setup.table.stage[stage],
      setup.stage_shape,
      setup.ends,
      setup.gamma,
      1.0 / setup.dx,
      stage,
      setup.splitting,
      setup.mean,
      last || limited || setup.splitting != Splitting::lf_stencil};
  launch(limited ? "drogue::gas::stage_limited" : "drogue::gas::stage", space, setup, setup.stage_shape,
         functor);
}

template <Reconstruction scheme, class ExecutionSpace>
void launch_stage(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                  bool limited, int stage) {
  if (precision == Precision::full) {
    if (limited)
      launch_stage_as<scheme, Precision::full, true>(space, setup, stage);
    else
      launch_stage_as<scheme, Precision::full, false>(space, setup, stage);
  } else {
    if (limited)
      launch_stage_as<scheme, Precision::split, true>(space, setup, stage);
    else
      launch_stage_as<scheme, Precision::split, false>(space, setup, stage);
  }
}

template <Reconstruction scheme, Precision precision, class ExecutionSpace>
void launch_step_as(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup) {
  const StepFunctor<ExecutionSpace, scheme, precision> functor{
      {setup.buffer[0], setup.buffer[1], setup.buffer[2]},
      setup.control,
      setup.table,
      setup.step_shape,
      setup.ends,
      setup.gamma,
      1.0 / setup.dx,
      setup.mean};
  launch("drogue::gas::step", space, setup, setup.step_shape, functor);
}

template <Reconstruction scheme, class ExecutionSpace>
void launch_step(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision) {
  if (precision == Precision::full)
    launch_step_as<scheme, Precision::full>(space, setup);
  else
    launch_step_as<scheme, Precision::split>(space, setup);
}

}  // namespace drogue::gas
