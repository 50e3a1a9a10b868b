#pragma once

#include <filesystem>
#include <string_view>

namespace drogue::run {

/// Temporary name of `target`: same directory, hidden, unique to this process.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Syncs a file, or the entries of a directory, to disk. Throws `Failure` (io_error).
void sync_path(const std::filesystem::path& path);

/// Syncs `temporary`, renames it to `target`, and syncs the directory. On failure removes `temporary`, leaves
/// a former `target` untouched, and throws `Failure` (io_error).
void replace_file(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// File that appears complete under its name or not at all; a former file stays until commit(). A target that
/// is no regular file (see `is_replaced`) is written directly.
class AtomicFile {
 public:
  /// Blocks until a reader opens `target` if it is a named pipe. All functions throw `Failure` (io_error).
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

/// Checks before a long run that its result can be written to `path`; leaves nothing behind. An empty path is
/// no request. Throws `Failure`: usage for `-`, io_error if `path` cannot be written.
void require_writable(const std::filesystem::path& path);

/// Replaces the content of `target` atomically. Throws `Failure` (io_error).
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace drogue::run
