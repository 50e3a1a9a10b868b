#pragma once

#include <filesystem>
#include <string>

namespace drogue::run {

/// New folder for temporary files, removed with all that it holds.
class TemporaryFolder {
 public:
  /// `name`: start of the name of the folder. Throws Failure (io_error) if it cannot be made.
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder() { remove(); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return _path; }

  /// Removes the folder early.
  void remove() noexcept;

 private:
  std::filesystem::path _path;
};

}  // namespace drogue::run
