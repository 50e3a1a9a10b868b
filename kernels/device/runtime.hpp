#pragma once

#include <memory>
#include <string>
#include <vector>

namespace drogue::device {

/// How threads of OpenMP wait for each other at the end of a loop.
enum class ThreadWaits {
  as_configured,  ///< settings of the environment, or those of OpenMP
  adapted,        ///< briefly on shared cores, before they sleep, unless the environment has settings
};

/// Threads of OpenMP of this process without options of Kokkos; 1 without OpenMP. Does not throw.
[[nodiscard]] int default_threads();

/// Initialises Kokkos for the lifetime of the object. Disables global fences around Kokkos Tools callbacks,
/// so that profiling neither slows steps nor prevents graph capture.
class Runtime {
 public:
  /// Initialises Kokkos with `arguments`, the `--kokkos-*` options. Throws std::invalid_argument for a number
  /// of threads or a device number, given as an option or as a KOKKOS_* variable, for which Kokkos would
  /// abort.
  explicit Runtime(const std::vector<std::string>& arguments, ThreadWaits waits = ThreadWaits::as_configured);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

 private:
  class ShortWaits;
  std::unique_ptr<ShortWaits> _short_waits;  ///< null: waits as configured
};

/// True between the construction of a `Runtime` that found the cores shared and shortened waits, and its
/// end. Does not throw.
[[nodiscard]] bool cores_are_shared();

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
