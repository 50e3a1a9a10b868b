#include "common/run/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "common/run/files/io_error.hpp"
#include "common/run/files/output_path.hpp"

namespace drogue::run {

std::filesystem::path temporary_name(const std::filesystem::path& target) {
  return target.parent_path() / ("." + target.filename().string() + "." + std::to_string(getpid()) + ".tmp");
}

void sync_path(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw io_failure("open", path, errno);
  const int error = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  // Some network file systems cannot sync a directory; the rename itself has happened.
  if (error != 0 && error != EINVAL) throw io_failure("write", path, error);
}

void replace_file(const std::filesystem::path& temporary, const std::filesystem::path& target) {
  try {
    sync_path(temporary);
    if (std::rename(temporary.c_str(), target.c_str()) != 0) throw io_failure("write", target, errno);
  } catch (...) {
    unlink(temporary.c_str());
    throw;
  }
  const std::filesystem::path directory = target.parent_path();
  sync_path(directory.empty() ? "." : directory);
}

AtomicFile::AtomicFile(std::filesystem::path target) : _target(std::move(target)) {
  if (const int own = own_descriptor(_target); own >= 0) {
    // Opened again, a file would be written from its beginning, over what stands there.
    _descriptor = fcntl(own, F_DUPFD_CLOEXEC, 0);
  } else if (is_replaced(_target)) {
    _temporary = temporary_name(_target);
    _descriptor = open(_temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  } else {
    _descriptor = open(_target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  }
  if (_descriptor < 0) throw io_failure("write", _target, errno);
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() noexcept {
  if (_descriptor < 0) return;
  close(_descriptor);
  _descriptor = -1;
  if (!_temporary.empty()) unlink(_temporary.c_str());
}

void AtomicFile::fail(int error) {
  discard();
  throw io_failure("write", _target, error);
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(_descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  // A pipe and most devices cannot be synced.
  if (fsync(_descriptor) != 0 && (!_temporary.empty() || errno != EINVAL)) fail(errno);
  const int descriptor = std::exchange(_descriptor, -1);
  // A network file system may report a full disk only here.
  if (close(descriptor) != 0) {
    const int error = errno;
    if (!_temporary.empty()) unlink(_temporary.c_str());
    throw io_failure("write", _target, error);
  }
  if (!_temporary.empty()) replace_file(_temporary, _target);
}

void require_writable(const std::filesystem::path& path) {
  if (path.empty() || own_descriptor(path) >= 0) return;
  if (path == "-")
    throw Failure(ExitCode::usage, "the output '-' is not a file name; standard output is /dev/stdout");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw io_failure("write", path, EISDIR);
  if (is_replaced(path)) {
    const AtomicFile probe(path);
  } else if (access(path.c_str(), W_OK) != 0) {  // a pipe cannot be opened without a reader
    throw io_failure("write", path, errno);
  }
}

void write_file_atomically(const std::filesystem::path& target, std::string_view content) {
  AtomicFile file(target);
  file.write(content);
  file.commit();
}

}  // namespace drogue::run
