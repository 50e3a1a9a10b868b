#include "common/run/files/io_error.hpp"

#include <system_error>

namespace drogue::run {

Failure io_failure(const std::string& action, const std::filesystem::path& path, int error) {
  return {ExitCode::io_error,
          "cannot " + action + " '" + path.string() + "': " + std::generic_category().message(error)};
}

}  // namespace drogue::run
