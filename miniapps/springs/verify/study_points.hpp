#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Scene of a study with the names of its settings.
struct StudyPoint {
  SpringsScene scene;
  std::string label, model, mass, integrator;
};

/// Scenes for `lists`, the value of `--study`, each scheme from coarse to fine; `sets` are the assignments of
/// the command line. The springs of model edge have stiffness sqrt(3)/2 E, the membrane of equilateral
/// triangles with E = 2/sqrt(3) k and nu = 1/3. A string with a stiffness per edge keeps its E A on every
/// mesh. Strings beside cloth keep E A and mass in every model. Meshes of more than `most_vertices` are made
/// with so many. Throws `Failure` (usage) for an invalid axis, otherwise like `read_springs_scene`.
std::vector<StudyPoint> study_points(const std::filesystem::path& file, const std::vector<std::string>& sets,
                                     const std::string& lists,
                                     std::int64_t most_vertices = std::numeric_limits<std::int64_t>::max());

/// Vertices of the largest of the meshes that `lists` names; 0 if it names none. Throws `Failure` (usage).
std::int64_t largest_study_mesh(const std::string& lists);

}  // namespace drogue::springs_app
