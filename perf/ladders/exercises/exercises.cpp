#include "perf/ladders/exercises/exercises.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "kernels/device/stopwatch.hpp"
#include "kernels/mesh/renumbering.hpp"
#include "perf/ladders/exercises/chunks.hpp"
#include "perf/ladders/exercises/correction.hpp"
#include "perf/ladders/exercises/divisions.hpp"
#include "perf/ladders/exercises/jumps.hpp"
#include "perf/ladders/exercises/order.hpp"
#include "perf/ladders/exercises/packed_differences.hpp"
#include "perf/ladders/exercises/sums.hpp"
#include "perf/ladders/exercises/tension.hpp"
#include "perf/ladders/exercises/uploads.hpp"
#include "perf/ladders/options/registers.hpp"
#include "perf/ladders/springs/recomputed.hpp"
#include "perf/ladders/transfers/one_upload.hpp"
#include "perf/ladders/transfers/overlapped.hpp"
#include "perf/ladders/transfers/pinned.hpp"
#include "perf/ladders/weno/one_division.hpp"

namespace drogue::perf::ladder {

/// Exercises on a backend, those of code that is right and slow last. Their factors are below those of the
/// solutions (docs/lessons/answers.md); those of a GPU follow from the records of its rungs.
template <class Space>
std::vector<Exercise> make_exercises(ExerciseCode code) {
  constexpr bool host = device::is_host<Space>;
  const bool own = code == ExerciseCode::own;
  const auto shared = [](auto made) { return std::make_shared<const decltype(made)>(std::move(made)); };
  const auto tube = shared(make_weno_problem(512, 6)), long_tube = shared(make_weno_problem(4096, 4));
  const auto sheet = shared(make_spring_problem(400, 8));
  const auto reordered = [&](VertexOrder order) { return shared(make_spring_problem(80'000, 2, order)); };
  const auto puts = shared(make_options_problem(5)), batch = shared(make_options_problem(host ? 16 : 1024));
  const auto values = shared(make_transfer_problem(5003, 3)),
             many_values = shared(make_transfer_problem(host ? 300'007 : 4'000'103, 20));
  return {
      {.name = "correction",
       .file = "perf/ladders/exercises/correction.hpp",
       .task = "Give the flux its nonlinear weights.",
       .rung = own ? differences_rung<Space, DifferenceFluxWith<CorrectionExercise>>(tube)
                   : differences_rung<Space>(tube)},
      {.name = "tension",
       .file = "perf/ladders/exercises/tension.hpp",
       .task = "Find the missing term of the tension.",
       .rung = own ? recomputed_rung<Space, TensionExercise>(sheet) : recomputed_rung<Space>(sheet)},
      {.name = "jumps",
       .file = "perf/ladders/exercises/jumps.hpp",
       .task = "Sum the jumps in their direction.",
       .rung = own ? registers_rung<Space, JumpsExercise>(puts) : registers_rung<Space>(puts)},
      {.name = "chunks",
       .file = "perf/ladders/exercises/chunks.hpp",
       .task = "Send every value to the device.",
       .rung = own ? overlapped_rung<Space, ChunksExercise>(values) : overlapped_rung<Space>(values)},
      {.name = "divisions",
       .file = "perf/ladders/exercises/divisions.hpp",
       .task = "Leave one division of five.",
       .rung = own ? packed_differences_rung<Space, DifferenceFluxWith<DivisionsExercise>>(long_tube)
                   : packed_differences_rung<Space, DifferenceFluxWith<OneDivisionCorrection>>(long_tube),
       .factor = host ? 1.3 : 1.1,
       .slow = packed_differences_rung<Space>(long_tube)},
      {.name = "order",
       .file = "perf/ladders/exercises/order.hpp",
       .task = "Number the vertices so that neighbours share lines.",
       .rung = recomputed_rung<Space>(reordered(own ? &OrderExercise::order : &mesh::reverse_cuthill_mckee)),
       .factor = host ? 1.5 : 1.15,
       .slow = recomputed_rung<Space>(reordered(nullptr))},
      {.name = "sums",
       .file = "perf/ladders/exercises/sums.hpp",
       .task = "Sum for several nodes at once.",
       .rung = own ? registers_rung<Space, SumsExercise>(batch) : registers_rung<Space>(batch),
       .factor = host ? 3.0 : 1.2,
       .slow = registers_rung<Space, PlainJumps>(batch)},
      {.name = "uploads",
       .file = "perf/ladders/exercises/uploads.hpp",
       .task = "Leave the values on the device between the steps.",
       .rung =
           own ? one_upload_rung<Space, UploadsExercise>(many_values) : one_upload_rung<Space>(many_values),
       .factor = host ? 1.3 : 4.0,
       .slow = pinned_rung<Space>(many_values)}};
}

std::vector<Exercise> create_exercises(device::Backend backend, ExerciseCode code) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_exercises<ExecutionSpace>(code); });
}

double error_of(const Exercise& exercise) {
  const auto run = exercise.rung.make();
  run->reset();
  run->run();
  return run->error();
}

double speed_up_of(const Exercise& exercise) {
  constexpr int rounds = 25;
  const std::unique_ptr<RungRun> runs[] = {exercise.slow.make(), exercise.rung.make()};
  double fastest[] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int round = -2; round < rounds; ++round)
    for (int k = 0; k < 2; ++k) {
      runs[k]->reset();
      const device::Stopwatch stopwatch;
      runs[k]->run();
      const double seconds = stopwatch.seconds();
      if (round >= 0) fastest[k] = std::min(fastest[k], seconds);
    }
  return fastest[0] / fastest[1];
}

}  // namespace drogue::perf::ladder
