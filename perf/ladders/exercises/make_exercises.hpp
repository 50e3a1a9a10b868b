#pragma once

#include <memory>
#include <utility>

#include "kernels/mesh/renumbering.hpp"
#include "perf/ladders/exercises/chunks.hpp"
#include "perf/ladders/exercises/correction.hpp"
#include "perf/ladders/exercises/divisions.hpp"
#include "perf/ladders/exercises/exercises.hpp"
#include "perf/ladders/exercises/jumps.hpp"
#include "perf/ladders/exercises/order.hpp"
#include "perf/ladders/exercises/packed_differences.hpp"
#include "perf/ladders/exercises/sums.hpp"
#include "perf/ladders/exercises/tension.hpp"
#include "perf/ladders/exercises/uploads.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/options/registers.hpp"
#include "perf/ladders/springs/recomputed.hpp"
#include "perf/ladders/transfers/one_upload.hpp"
#include "perf/ladders/transfers/overlapped.hpp"
#include "perf/ladders/weno/one_division.hpp"

namespace drogue::perf::ladder {

/// Exercises whose rungs are right and slow. The factors are below those of the solutions
/// (docs/lessons/answers.md); those of a GPU follow from the records of its rungs.
template <class ExecutionSpace>
Exercise faster_weno(ExerciseCode code) {
  using Slow = PackedDifferencesRung<ExecutionSpace>;
  using Own = PackedDifferencesRung<ExecutionSpace, DifferenceFluxWith<DivisionsExercise>>;
  using Solution = PackedDifferencesRung<ExecutionSpace, DifferenceFluxWith<OneDivisionCorrection>>;
  const auto problem = std::make_shared<const WenoProblem>(make_weno_problem(4096, 4));
  return {.name = "divisions",
          .file = "perf/ladders/exercises/divisions.hpp",
          .task = "Leave one division of five.",
          .rung = code == ExerciseCode::own ? make_rung<Own>(problem, weno_tolerance)
                                            : make_rung<Solution>(problem, weno_tolerance),
          .factor = device::is_host<ExecutionSpace> ? 1.3 : 1.1,
          .slow = make_rung<Slow>(problem, weno_tolerance)};
}

template <class ExecutionSpace>
Exercise faster_springs(ExerciseCode code) {
  using Same = RecomputedRung<ExecutionSpace>;
  const VertexOrder order = code == ExerciseCode::own ? &OrderExercise::order : &mesh::reverse_cuthill_mckee;
  const auto made = [](VertexOrder reorder) {
    const auto problem = std::make_shared<const SpringProblem>(make_spring_problem(80'000, 2, reorder));
    return make_rung<Same>(problem, spring_tolerance);
  };
  return {.name = "order",
          .file = "perf/ladders/exercises/order.hpp",
          .task = "Number the vertices so that neighbours share lines.",
          .rung = made(order),
          .factor = device::is_host<ExecutionSpace> ? 1.5 : 1.15,
          .slow = made(nullptr)};
}

template <class ExecutionSpace>
Exercise faster_options(ExerciseCode code) {
  using Slow = OptionRegistersRung<ExecutionSpace, PlainJumps>;
  using Own = OptionRegistersRung<ExecutionSpace, SumsExercise>;
  using Solution = OptionRegistersRung<ExecutionSpace>;
  constexpr bool host = device::is_host<ExecutionSpace>;
  const auto problem = std::make_shared<const OptionsProblem>(make_options_problem(host ? 16 : 1024));
  return {.name = "sums",
          .file = "perf/ladders/exercises/sums.hpp",
          .task = "Sum for several nodes at once.",
          .rung = code == ExerciseCode::own ? make_rung<Own>(problem, options_tolerance)
                                            : make_rung<Solution>(problem, options_tolerance),
          .factor = host ? 3.0 : 1.2,
          .slow = make_rung<Slow>(problem, options_tolerance)};
}

template <class ExecutionSpace>
Exercise faster_transfers(ExerciseCode code) {
  using Own = OneUploadRung<ExecutionSpace, UploadsExercise>;
  constexpr bool host = device::is_host<ExecutionSpace>;
  const auto problem =
      std::make_shared<const TransferProblem>(make_transfer_problem(host ? 300'007 : 4'000'103, 20));
  return {.name = "uploads",
          .file = "perf/ladders/exercises/uploads.hpp",
          .task = "Leave the values on the device between the steps.",
          .rung = code == ExerciseCode::own
                      ? make_rung<Own>(problem, transfer_tolerance)
                      : make_rung<OneUploadRung<ExecutionSpace>>(problem, transfer_tolerance),
          .factor = host ? 1.3 : 4.0,
          .slow = make_rung<PinnedRung<ExecutionSpace>>(problem, transfer_tolerance)};
}

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
               make_transfer_problem(5003, 3), transfer_tolerance)},
          faster_weno<Space>(code),
          faster_springs<Space>(code),
          faster_options<Space>(code),
          faster_transfers<Space>(code)};
}

}  // namespace drogue::perf::ladder
