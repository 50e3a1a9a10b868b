#include "common/program/shipped_folder.hpp"

#include <system_error>

namespace drogue {

std::filesystem::path find_shipped_folder(const std::string& name,
                                          const std::filesystem::path& source_folder) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path installed = program.parent_path().parent_path() / "share/drogue" / name;
  if (!error && std::filesystem::is_directory(installed, error)) return installed;
  return source_folder;
}

}  // namespace drogue
