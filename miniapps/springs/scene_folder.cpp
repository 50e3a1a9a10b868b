#include "miniapps/springs/scene_folder.hpp"

namespace drogue::springs_app {

std::filesystem::path scene_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path installed = program.parent_path().parent_path() / "share/drogue/scenes/springs";
  if (!error && std::filesystem::is_directory(installed, error)) return installed;
  return DROGUE_SPRINGS_SCENES;
}

}  // namespace drogue::springs_app
