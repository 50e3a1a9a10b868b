#pragma once

#include <string>
#include <vector>

namespace drogue::device {

/// Initialises Kokkos for the lifetime of the object. Disables global fences around Kokkos Tools callbacks,
/// so that profiling neither slows steps nor prevents graph capture.
class Runtime {
 public:
  /// Initialises Kokkos with `arguments`, the `--kokkos-*` options. Throws std::invalid_argument for a number
  /// of threads or a device number, given as an option or as a KOKKOS_* variable, for which Kokkos would
  /// abort.
  explicit Runtime(const std::vector<std::string>& arguments);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
};

/// Facts about the software and the device of a run.
struct DeviceFacts {
  std::string kokkos_version;
  std::string gpu;              ///< name of the device, empty without one
  std::string driver;           ///< CUDA driver version, empty without one
  int threads = 1;              ///< number of threads of the OpenMP backend
  std::string capability = {};  ///< compute capability of the device, "9.0"; empty without one
};

/// Version of Kokkos, for example "4.5.1". Does not throw.
[[nodiscard]] std::string kokkos_version();

/// Facts about the present device. Requires an initialised runtime. Does not throw.
[[nodiscard]] DeviceFacts device_facts();

}  // namespace drogue::device
