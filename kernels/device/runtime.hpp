#pragma once

#include <string>
#include <vector>

namespace drogue::device {

/// Initialises Kokkos for the life of the object. `arguments` are `--kokkos-*` options. Global fences around
/// callbacks are switched off, so that tools and the ledger neither slow a step nor break the capture of a
/// graph. Throws std::invalid_argument for a number of threads or a device, given as an option or as a
/// KOKKOS_* variable, at which Kokkos would abort or crash.
class Runtime {
 public:
  explicit Runtime(const std::vector<std::string>& arguments);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
};

struct DeviceFacts {
  std::string kokkos_version;
  std::string gpu;     ///< name of the device, empty without one
  std::string driver;  ///< CUDA driver version, empty without one
  int threads = 1;     ///< of the OpenMP backend
};

[[nodiscard]] std::string kokkos_version();

/// After `Runtime`.
[[nodiscard]] DeviceFacts device_facts();

}  // namespace drogue::device
