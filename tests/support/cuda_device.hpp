#pragma once

#include "kernels/device/backend.hpp"
#include "tests/support/in_child.hpp"

namespace drogue::testing {

/// Queries the device in a child process: CUDA does not start in children of a process that has queried it.
inline bool has_cuda_device() {
  static const bool present =
      in_child([] { return std::string(device::is_present(device::Backend::cuda) ? "yes" : "no"); }) == "yes";
  return present;
}

/// True if a child of this process can run on a backend that is compiled in.
inline bool runs_in_child(device::Backend backend) {
  return backend != device::Backend::cuda || has_cuda_device();
}

}  // namespace drogue::testing
