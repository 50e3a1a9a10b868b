#pragma once

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Rung with a fault or a gap to mend, or one that is right and slow.
struct Exercise {
  const char* name;
  const char* file;  ///< to edit
  const char* task;  ///< a sentence
  Rung rung;
  double factor = 0.0;  ///< time of `slow` over that of the mended rung at least; 0: its error alone counts
  Rung slow = {};       ///< the rung as it was shipped, of an exercise with a factor
};

/// Code of the exercises: as in their files, or that of the ladder which they were made from.
enum class ExerciseCode { own, solution };

/// Exercises on small problems. Throws std::invalid_argument for a backend that is not compiled in.
[[nodiscard]] std::vector<Exercise> create_exercises(device::Backend backend, ExerciseCode code);

/// Error of an exercise's rung, which is mended if its tolerance is met. Requires an initialised runtime.
/// Blocking. Throws what a failed kernel throws.
[[nodiscard]] double error_of(const Exercise& exercise);

/// Time of the slow rung over that of the exercise's, of the fastest of some runs in turn. Requires an
/// initialised runtime and a factor. Blocking. Throws what a failed kernel throws.
[[nodiscard]] double speed_up_of(const Exercise& exercise);

}  // namespace drogue::perf::ladder
