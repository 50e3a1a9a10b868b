#pragma once

#include "perf/ladders/options/option_team.hpp"

namespace drogue::perf::ladder {

/// Rung 4. The arrays of an option and the weights in scratch memory, which is shared memory on a GPU.
///
/// Prediction: memory traffic of one load and one store per option; arithmetic as before.
template <class ExecutionSpace>
class ScratchRung final : public OptionsRung<ExecutionSpace, Kokkos::LayoutRight> {
 public:
  static constexpr RungText text{
      "scratch", "Values and weights in scratch memory.",
      "On a host nothing changes: the first cache held the arrays of an option already. On an "
      "H100 1536 us, after 2179 us, where the model has 148 us: one thread still solves while "
      "the others wait (docs/lessons/tables.md)."};

  static Work work(const OptionsProblem& problem) { return options_work(problem, 1, 16.0 / option_steps); }

  using OptionsRung<ExecutionSpace, Kokkos::LayoutRight>::OptionsRung;

 protected:
  void solve() override {
    launch_option_teams<ExecutionSpace, PlainJumps, true>(this->space(), "drogue::perf::ladder::scratch",
                                                          this->arrays(), this->problem().options(),
                                                          option_nodes);
  }
};

}  // namespace drogue::perf::ladder
