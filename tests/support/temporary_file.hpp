#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "common/run/files/temporary_folder.hpp"

namespace drogue::testing {

/// File in a folder of its own, which both go with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content, const std::string& name = "scene.toml")
      : _path(_folder.path() / name) {
    add(name, content);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return _path; }
  /// Adds another file to the folder.
  void add(const std::string& name, const std::string& content) const {
    std::ofstream(_folder.path() / name, std::ios::binary) << content;
  }

 private:
  const run::TemporaryFolder _folder{"drogue-test"};
  const std::filesystem::path _path;
};

}  // namespace drogue::testing
