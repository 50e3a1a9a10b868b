#include "common/run/files/temporary_folder.hpp"

#include <stdlib.h>

#include <system_error>

#include "common/program/failure.hpp"

namespace drogue::run {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::string pattern = (fs::temp_directory_path() / (name + "-XXXXXX")).string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw Failure(ExitCode::io_error,
                  "no temporary folder can be made in '" + fs::temp_directory_path().string() + "'");
  _path = pattern;
}

void TemporaryFolder::remove() noexcept {
  std::error_code error;
  fs::remove_all(_path, error);
}

}  // namespace drogue::run
