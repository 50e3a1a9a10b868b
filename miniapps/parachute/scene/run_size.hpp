#pragma once

#include <string>

#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Size of a run before it is made.
struct RunSize {
  double cells = 0.0;
  double bytes = 0.0;        ///< of the arrays of the flow and of its outputs
  double steps = 0.0;        ///< of the flow; 0 where the speed of the fluid at the start is not known
  double cloth_steps = 0.0;  ///< of the cloth, of all canopies, in each of them
};

/// Duration of a step of the flow, s, where the fluid moves `times_as_fast` as at the start; 0 if that
/// velocity varies in space or if nothing bounds the step. Throws only std::bad_alloc.
[[nodiscard]] double step_length(const FlowScene& scene, double times_as_fast = 1.0);

/// Size of the run of a checked scene with a fluid. The steps are those of the speed at the start. Throws
/// only std::bad_alloc.
[[nodiscard]] RunSize run_size(const FlowScene& scene);

/// Expected time of a run on two machines, s; 0 where its steps are not known.
struct RunTime {
  double two_cores = 0.0, h200 = 0.0;
};

/// Expected time of the run of a checked scene with a fluid. Throws only std::bad_alloc.
[[nodiscard]] RunTime run_time(const FlowScene& scene);

/// A duration in seconds, minutes or hours, for sentences.
[[nodiscard]] std::string duration_text(double seconds);

/// Lines of `--check` on grid, memory and time of a scene with a fluid. Throws only std::bad_alloc.
[[nodiscard]] std::string run_size_report(const FlowScene& scene);

}  // namespace drogue::parachute_app
