#pragma once

#include <filesystem>
#include <string_view>

namespace drogue::run {

/// Name under which a file is written before it replaces `target`: same directory, hidden, own to this
/// process.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Forces a file, or the entries of a directory, to disk. Throws Failure(io_error).
void sync_path(const std::filesystem::path& path);

/// Syncs `temporary`, renames it to `target`, syncs the directory. Throws Failure(io_error), `temporary`
/// removed, a former `target` untouched.
void replace_file(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// A file that appears under its name complete and on disk, or not at all: until commit() a former file
/// stays. What has the name and is no file (see `is_replaced`) gets every byte at once.
class AtomicFile {
 public:
  /// Waits for a reader where `target` is a named pipe. Throws Failure(io_error), as the others do.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(int error);
  void discard() noexcept;

  std::filesystem::path _target;
  std::filesystem::path _temporary;  ///< empty where bytes go straight to the target
  int _descriptor = -1;
};

/// Replaces `target` by `content` in one go. Throws Failure(io_error).
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace drogue::run
