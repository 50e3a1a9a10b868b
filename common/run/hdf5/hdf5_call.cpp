#include "common/run/hdf5/hdf5_call.hpp"

#include <cerrno>
#include <cstdlib>

#include "common/run/files/io_error.hpp"

namespace drogue::run::h5 {
namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

struct Cause {
  int system_error = 0;
  std::string text;
};

/// Visits the error stack from the innermost call outwards; only the text of a description holds the errno.
herr_t look_at(unsigned, const H5E_error2_t* error, void* data) {
  auto& cause = *static_cast<Cause*>(data);
  const std::string text = error->desc == nullptr ? "" : error->desc;
  if (cause.text.empty()) cause.text = text;
  const std::string mark = "errno = ";
  const std::size_t position = text.find(mark);
  if (cause.system_error == 0 && position != std::string::npos) {
    cause.system_error = std::atoi(text.c_str() + position + mark.size());
  }
  return 0;
}

}  // namespace

Lock::Lock() : _lock(library_mutex()) {
  // HDF5 crashes in its exit handler after a failed close, say on a full disk. The handler is unnecessary:
  // owners close every handle.
  static const herr_t without_exit_handler = H5dont_atexit();
  static_cast<void>(without_exit_handler);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void open_library() {
  const Lock lock;
  if (H5open() < 0) throw Failure(ExitCode::io_error, "cannot open the HDF5 library");
}

void fail(const std::string& action, const std::filesystem::path& path) {
  Cause cause;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look_at, &cause);
  if (const char* locking = std::getenv("HDF5_USE_FILE_LOCKING");
      locking != nullptr && (cause.system_error == EAGAIN || cause.system_error == EWOULDBLOCK))
    throw Failure(ExitCode::io_error, "cannot " + action + " '" + path.string() +
                                          "': another program has locked it, since HDF5_USE_FILE_LOCKING = " +
                                          locking + "; close that program, or unset the variable in both");
  if (cause.system_error != 0) throw io_failure(action, path, cause.system_error);
  if (cause.text.empty()) cause.text = "HDF5 gives no reason";
  throw Failure(ExitCode::io_error, "cannot " + action + " '" + path.string() + "': " + cause.text);
}

void fail(const std::string& action, hid_t object) {
  // A query of the name would clear the error stack.
  const hid_t stack = H5Eget_current_stack();
  char name[4096] = "";
  H5Fget_name(object, name, sizeof name);
  H5Eset_current_stack(stack);
  fail(action, std::filesystem::path(name));
}

}  // namespace drogue::run::h5
