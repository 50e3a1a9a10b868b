#pragma once

#include "kernels/gas/stage.hpp"

namespace drogue::gas {

/// What the stage kernels of one solver share.
template <class ExecutionSpace>
struct StageSetup {
  FieldsView<ExecutionSpace> buffer[3];
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> touched;
  StageTable table;
  Ends ends;
  TileShape shape;
  int team_size;
  double gamma, dx;
  Splitting splitting;
  Mean mean;
};

/// Enqueues stage `stage` of a step. One of the explicit instantiations in stage_*.cpp.in.
template <Reconstruction scheme, class ExecutionSpace>
void launch_stage(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                  bool limited, int stage);

/// Most threads of a team on a device; the default 128 has registers to spare, and larger ones exist for
/// studies.
inline constexpr int default_team = 128, largest_team = 512;

template <class Policy, class ExecutionSpace, Reconstruction scheme, Precision precision, bool limited>
void launch_stage_as(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, int stage) {
  using Functor = StageFunctor<ExecutionSpace, scheme, precision, limited>;
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename Functor::Fields::memory_space>::accessible);
  const bool last = stage == setup.table.stages - 1;
  const Functor functor{{setup.buffer[0], setup.buffer[1], setup.buffer[2]},
                        setup.control,
                        setup.touched,
                        setup.table.stage[stage],
                        setup.shape,
                        setup.ends,
                        setup.gamma,
                        1.0 / setup.dx,
                        stage,
                        setup.splitting,
                        setup.mean,
                        last || limited || setup.splitting != Splitting::lf_stencil};
  const auto tiles = static_cast<int>((setup.ends.cells + setup.shape.cells - 1) / setup.shape.cells);
  Policy policy(space, tiles, setup.team_size);
  policy.set_scratch_size(
      0, Kokkos::PerTeam(static_cast<int>(Tile<ExecutionSpace>::scratch_bytes(setup.shape) + 64)));
  // A light functor travels as a kernel argument; the other way, through constant memory, cannot be captured.
  Kokkos::parallel_for(
      limited ? "drogue::gas::stage_limited" : "drogue::gas::stage",
      Kokkos::Experimental::require(policy, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

template <class Policy, Reconstruction scheme, class ExecutionSpace>
void launch_stage_with(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup,
                       Precision precision, bool limited, int stage) {
  if (precision == Precision::full) {
    if (limited)
      launch_stage_as<Policy, ExecutionSpace, scheme, Precision::full, true>(space, setup, stage);
    else
      launch_stage_as<Policy, ExecutionSpace, scheme, Precision::full, false>(space, setup, stage);
  } else {
    if (limited)
      launch_stage_as<Policy, ExecutionSpace, scheme, Precision::split, true>(space, setup, stage);
    else
      launch_stage_as<Policy, ExecutionSpace, scheme, Precision::split, false>(space, setup, stage);
  }
}

template <Reconstruction scheme, class ExecutionSpace>
void launch_stage(const ExecutionSpace& space, const StageSetup<ExecutionSpace>& setup, Precision precision,
                  bool limited, int stage) {
  if constexpr (device::is_host<ExecutionSpace>) {
    launch_stage_with<Kokkos::TeamPolicy<ExecutionSpace>, scheme>(space, setup, precision, limited, stage);
  } else {
    // Five blocks of 128 threads an SM leave 96 registers; hand-written kernels were fastest there.
    using Default = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<default_team, 5>>;
    using Large = Kokkos::TeamPolicy<ExecutionSpace, Kokkos::LaunchBounds<largest_team, 1>>;
    if (setup.team_size <= default_team)
      launch_stage_with<Default, scheme>(space, setup, precision, limited, stage);
    else
      launch_stage_with<Large, scheme>(space, setup, precision, limited, stage);
  }
}

}  // namespace drogue::gas
