#pragma once

#include "perf/ladders/options/option_team.hpp"

namespace drogue::perf::ladder {

/// Rung 3. A team of 128 threads per option, a thread per node; one thread solves the tridiagonal system.
///
/// Prediction: none on a host, whose teams are single threads. The model of a GPU has no idle threads.
template <class ExecutionSpace>
Rung one_team_rung(const Shared<OptionsProblem>& problem) {
  return make_rung<TeamRung<ExecutionSpace, PlainJumps, false>>(
      RungText{"one-team", "A team per option, a thread per node.",
               "A host is back at the time of a thread per option, as predicted: a team is one thread "
               "there. On a GPU one thread of 128 solves while the others wait. On an H100 this takes "
               "2179 us all the same, after 11302 us; the model has 227 us for both, since it takes all "
               "threads as busy (docs/lessons/tables.md)."},
      options_work(*problem, 1, 40), problem, "drogue::perf::ladder::one_team", option_nodes);
}

}  // namespace drogue::perf::ladder
