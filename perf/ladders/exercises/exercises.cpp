#include "perf/ladders/exercises/exercises.hpp"

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

}  // namespace drogue::perf::ladder
