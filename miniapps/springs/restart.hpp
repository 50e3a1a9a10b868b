#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/fabric/state.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// What a scene says of its steps; it may change between a run and its continuation.
struct AskedSteps {
  double dt = 0.0;  ///< s; 0 where they follow from stability
  double safety = 0.0;
  bool operator==(const AskedSteps&) const = default;
};
AskedSteps asked_steps(const SpringsScene& scene);

/// All that a restarted run needs to go on with the same bits, vertices in the scene's numbering.
struct RestartState {
  fabric::TimeState clock;
  std::int64_t stop_step = 0;         ///< at which the steps in progress reach `stop_time`
  double stop_time = 0.0;             ///< s
  double dt_min = 0.0, dt_max = 0.0;  ///< s, of the steps so far
  AskedSteps asked;                   ///< by the scene that took them
  std::vector<fabric::Vector> x, v;
  std::vector<fabric::ContactWork> contact_work;  ///< of every vertex; empty without contact
};

/// Names the mesh, the fabric and what acts on it; output, end time, length of steps and checks may change
/// between a run and its continuation.
std::string scene_fingerprint(SpringsScene scene);

/// Writes atomically.
void write_restart(const std::filesystem::path& file, const std::string& fingerprint,
                   const RestartState& state);

/// Throws Failure(io_error) for a file that is damaged or of another scene.
RestartState read_restart(const std::filesystem::path& file, const SpringsScene& scene);

}  // namespace drogue::springs_app
