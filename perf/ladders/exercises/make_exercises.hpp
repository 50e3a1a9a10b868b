#pragma once

#include <memory>
#include <utility>

#include "perf/ladders/exercises/chunks.hpp"
#include "perf/ladders/exercises/correction.hpp"
#include "perf/ladders/exercises/exercises.hpp"
#include "perf/ladders/exercises/jumps.hpp"
#include "perf/ladders/exercises/tension.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/options/registers.hpp"
#include "perf/ladders/springs/recomputed.hpp"
#include "perf/ladders/transfers/overlapped.hpp"
#include "perf/ladders/weno/differences.hpp"

namespace drogue::perf::ladder {

template <class ExecutionSpace>
std::vector<Exercise> make_exercises(ExerciseCode code) {
  using Space = ExecutionSpace;
  // A rung made from the exercise's code, or from that of the ladder.
  const auto rung = [&]<class Own, class Solution, class Problem>(Problem made, double tolerance) {
    const auto problem = std::make_shared<const Problem>(std::move(made));
    return code == ExerciseCode::own ? make_rung<Own>(problem, tolerance)
                                     : make_rung<Solution>(problem, tolerance);
  };
  using OwnFlux = DifferenceFluxWith<CorrectionExercise>;
  return {{"correction", "perf/ladders/exercises/correction.hpp", "Give the flux its nonlinear weights.",
           rung.template operator()<DifferencesRung<Space, OwnFlux>, DifferencesRung<Space>>(
               make_weno_problem(512, 6), weno_tolerance)},
          {"tension", "perf/ladders/exercises/tension.hpp", "Find the missing term of the tension.",
           rung.template operator()<RecomputedRung<Space, TensionExercise>, RecomputedRung<Space>>(
               make_spring_problem(400, 8), spring_tolerance)},
          {"jumps", "perf/ladders/exercises/jumps.hpp", "Sum the jumps in their direction.",
           rung.template operator()<OptionRegistersRung<Space, JumpsExercise>, OptionRegistersRung<Space>>(
               make_options_problem(5), options_tolerance)},
          {"chunks", "perf/ladders/exercises/chunks.hpp", "Send every value to the device.",
           rung.template operator()<OverlappedRung<Space, 8, ChunksExercise>, OverlappedRung<Space>>(
               make_transfer_problem(5003, 3), transfer_tolerance)}};
}

}  // namespace drogue::perf::ladder
