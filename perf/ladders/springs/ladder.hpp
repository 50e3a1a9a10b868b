#pragma once

#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/springs/arrays.hpp"
#include "perf/ladders/springs/graph.hpp"
#include "perf/ladders/springs/packets.hpp"
#include "perf/ladders/springs/recomputed.hpp"
#include "perf/ladders/springs/renumbered.hpp"
#include "perf/ladders/springs/rings.hpp"
#include "perf/ladders/springs/structs.hpp"

namespace drogue::perf::ladder {

/// Rungs of the spring ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_springs(bool small) {
  const bool host = device::is_host<ExecutionSpace>;
  const int vertices = small ? 400 : host ? 20'000 : 30'000;
  const long steps = small ? 8 : host ? 4 : 20;
  const auto problem = std::make_shared<const SpringProblem>(make_spring_problem(vertices, steps));
  return {.name = "springs",
          .unit = "step",
          .problem = "a stretched sheet of biquadratic springs by Runge-Kutta steps",
          .size = static_cast<std::int64_t>(problem->renumbered.vertices()),
          .units = steps,
          .rungs = {make_rung<StructsRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<ArraysRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<RecomputedRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<RenumberedRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<RingsRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<SpringGraphRung<ExecutionSpace>>(problem, spring_tolerance),
                    make_rung<PacketsRung<ExecutionSpace>>(problem, spring_tolerance)}};
}

}  // namespace drogue::perf::ladder
