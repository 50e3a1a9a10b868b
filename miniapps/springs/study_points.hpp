#pragma once

#include <string>
#include <vector>

#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// A scene of a study, and how its settings are called.
struct StudyPoint {
  SpringsScene scene;
  std::string label, model, mass, integrator;
};

/// The scenes that `lists`, the value of `--study`, asks for, each scheme from coarse to fine; `sets` are the
/// assignments of the command line. The springs of model edge have stiffness sqrt(3)/2 E, the membrane that
/// equilateral triangles of them are, E = 2/sqrt(3) k and nu = 1/3; a string whose scene gives a stiffness an
/// edge keeps its E A on every mesh. Strings beside cloth keep their E A and mass in every model. Throws
/// Failure(usage) for a wrong axis, and what `read_springs_scene` throws.
std::vector<StudyPoint> study_points(const std::filesystem::path& file, const std::vector<std::string>& sets,
                                     const std::string& lists);

}  // namespace drogue::springs_app
