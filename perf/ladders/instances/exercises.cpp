#include "perf/ladders/exercises/make_exercises.hpp"

namespace drogue::perf::ladder {

template std::vector<Exercise> make_exercises<DROGUE_INSTANCE_SPACE>(ExerciseCode);

}  // namespace drogue::perf::ladder
