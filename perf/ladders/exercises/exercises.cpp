#include "perf/ladders/exercises/exercises.hpp"

#include <algorithm>
#include <limits>

#include "kernels/device/stopwatch.hpp"

namespace drogue::perf::ladder {

// Defined in make_exercises.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::vector<Exercise> make_exercises(ExerciseCode code);

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
