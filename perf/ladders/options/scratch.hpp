#pragma once

#include "perf/ladders/options/option_team.hpp"

namespace drogue::perf::ladder {

/// Rung 4. The arrays of an option and the weights in scratch memory, which is shared memory on a GPU.
///
/// Prediction: memory traffic of one load and one store per option; arithmetic as before.
template <class ExecutionSpace>
Rung scratch_rung(const Shared<OptionsProblem>& problem) {
  return make_rung<TeamRung<ExecutionSpace, PlainJumps, true>>(
      RungText{"scratch", "Values and weights in scratch memory.",
               "On a host nothing changes: the first cache held the arrays of an option already. On an "
               "H100 1536 us, after 2179 us, where the model has 148 us: one thread still solves while "
               "the others wait (docs/lessons/tables.md)."},
      options_work(*problem, 1, 16.0 / option_steps), problem, "drogue::perf::ladder::scratch", option_nodes);
}

}  // namespace drogue::perf::ladder
