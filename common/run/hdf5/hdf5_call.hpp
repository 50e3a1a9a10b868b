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

/// Throws `Failure` (io_error) `cannot <action> 'path': <cause>` with the innermost cause that HDF5 recorded.
[[noreturn]] void fail(const std::string& action, const std::filesystem::path& path);

/// Overload for the file that holds `object`.
[[noreturn]] void fail(const std::string& action, hid_t object);

}  // namespace drogue::run::h5
