#pragma once

#include "kernels/device/launch.hpp"
#include "kernels/gas/stepping/launch.hpp"
#include "kernels/gas/stepping/persistent_step.hpp"
#include "kernels/gas/stepping/stage.hpp"
#include "kernels/gas/stepping/step.hpp"

namespace drogue::gas {

template <class Policy, class ExecutionSpace, class Functor>
void launch_tiles(const char* label, const ExecutionSpace& space, const TileShape& shape, std::int64_t tiles,
                  int team_size, const Functor& functor) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename Functor::Fields::memory_space>::accessible);
  Policy policy(space, static_cast<int>(tiles), team_size);
  policy.set_scratch_size(
      0, Kokkos::PerTeam(static_cast<int>(Tile<ExecutionSpace>::scratch_bytes(shape) + scratch_margin)));
  device::launch_teams(label, policy, functor);
}

template <bool many_slots, class ExecutionSpace, class Functor>
void launch(const char* label, const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup,
            const TileShape& shape, const Functor& functor) {
  const std::int64_t tiles = (setup.boundaries.cells + shape.cells - 1) / shape.cells;
  if constexpr (device::is_host<ExecutionSpace>) {
    launch_tiles<Kokkos::TeamPolicy<ExecutionSpace>>(label, space, shape, tiles, setup.team_size, functor);
  } else {
    using Usual = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<default_team, default_teams>>;
    using Large = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<largest_team, largest_teams>>;
    if constexpr (many_slots) {
      using Dense = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<default_team, dense_teams>>;
      if (setup.team_size <= default_team && shape.stride > setup.team_size)
        return launch_tiles<Dense>(label, space, shape, tiles, setup.team_size, functor);
    }
    if (setup.team_size <= default_team)
      launch_tiles<Usual>(label, space, shape, tiles, setup.team_size, functor);
    else
      launch_tiles<Large>(label, space, shape, tiles, setup.team_size, functor);
  }
}

template <Reconstruction scheme, Precision precision, bool limited, class ExecutionSpace>
void launch_stage_as(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, int stage) {
  const bool last = stage == setup.table.stages - 1;
  const StageFunctor<ExecutionSpace, scheme, precision, limited> functor{
      .buffer = {setup.buffer[0], setup.buffer[1], setup.buffer[2]},
      .control = setup.control,
      .limited_cells = setup.limited_cells,
      .weights = setup.table.stage[stage],
      .shape = setup.stage_shape,
      .boundaries = setup.boundaries,
      .gamma = setup.gamma,
      .inverse_dx = 1.0 / setup.dx,
      .stage = stage,
      .splitting = setup.splitting,
      .average = setup.average,
      .reduce_speed = last || limited || setup.splitting != Splitting::lf_stencil};
  launch<false>(limited ? "drogue::gas::stage_limited" : "drogue::gas::stage", space, setup,
                setup.stage_shape, functor);
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

template <Reconstruction scheme, Precision precision, bool limited, class ExecutionSpace>
StepFunctor<ExecutionSpace, scheme, precision, limited> step_functor(const StageSetup<ExecutionSpace>& setup,
                                                                     const TileShape& shape) {
  return {.buffer = {setup.buffer[0], setup.buffer[1], setup.buffer[2]},
          .control = setup.control,
          .limited_cells = setup.limited_cells,
          .table = setup.table,
          .shape = shape,
          .boundaries = setup.boundaries,
          .gamma = setup.gamma,
          .inverse_dx = 1.0 / setup.dx,
          .average = setup.average};
}

template <Reconstruction scheme, Precision precision, class ExecutionSpace>
void launch_step_as(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, bool limited) {
  if (limited)
    launch<true>("drogue::gas::step_limited", space, setup, setup.step_shape,
                 step_functor<scheme, precision, true>(setup, setup.step_shape));
  else
    launch<true>("drogue::gas::step", space, setup, setup.step_shape,
                 step_functor<scheme, precision, false>(setup, setup.step_shape));
}

template <Reconstruction scheme, Precision precision, class ExecutionSpace>
void launch_persistent_steps_as(const StageSetup<ExecutionSpace>& setup,
                                const PersistentSetup<ExecutionSpace>& persistent,
                                std::int64_t max_steps_per_launch) {
  const PersistentStepFunctor<ExecutionSpace, scheme, precision> functor{
      .step = step_functor<scheme, precision, false>(setup, persistent.shape),
      .status = persistent.status,
      .constants = persistent.constants,
      .max_steps_per_launch = max_steps_per_launch};
  persistent.grid.template launch<largest_persistent_team, 1>(functor);
}

template <Reconstruction scheme, class ExecutionSpace>
void launch_persistent_steps(const StageSetup<ExecutionSpace>& setup,
                             const PersistentSetup<ExecutionSpace>& persistent, Precision precision,
                             std::int64_t max_steps_per_launch) {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    if (precision == Precision::full)
      launch_persistent_steps_as<scheme, Precision::full>(setup, persistent, max_steps_per_launch);
    else
      launch_persistent_steps_as<scheme, Precision::split>(setup, persistent, max_steps_per_launch);
  }
}

template <Reconstruction scheme, class ExecutionSpace>
void launch_step(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                 bool limited) {
  if (precision == Precision::full)
    launch_step_as<scheme, Precision::full>(space, setup, limited);
  else
    launch_step_as<scheme, Precision::split>(space, setup, limited);
}

}  // namespace drogue::gas
