#pragma once

#include <filesystem>

namespace drogue::springs_app {

/// Where the shipped scenes are: beside the installed or bundled program, else in the source tree it was
/// built from.
std::filesystem::path scene_folder();

}  // namespace drogue::springs_app
