#pragma once

#include <hdf5.h>

#include <filesystem>
#include <mutex>
#include <string>

namespace drogue::run::h5 {

/// Serializes calls into the library, and suppresses its error printing on this thread.
class Lock {
 public:
  Lock();

 private:
  std::unique_lock<std::recursive_mutex> _lock;
};

/// Prepares the library. Call it before MPI is initialised: otherwise HDF5 ends when MPI does, and crashes
/// there if a file could not be closed, say on a full disk.
void open_library();

/// Throws `Failure` (io_error) `cannot <action> 'path': <cause>` with the innermost cause that HDF5 recorded.
[[noreturn]] void fail(const std::string& action, const std::filesystem::path& path);

/// Overload for the file that holds `object`.
[[noreturn]] void fail(const std::string& action, hid_t object);

}  // namespace drogue::run::h5
