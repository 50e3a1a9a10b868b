#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/run/result_document.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"

namespace drogue::framework {

/// Backend for the value of `--backend`. `useful_threads`: number of host threads that pay for the work; if
/// it is 1, or this process may use one core only, `auto` takes serial where it would take openmp. Throws
/// `Failure` (no_backend) if the backend is not compiled in or no device is present.
[[nodiscard]] device::Backend choose_backend(const std::string& option, int useful_threads);

/// Throws `Failure` (no_backend) if the backend is not compiled in or no device is present.
void require_backend(device::Backend backend);

/// Kokkos and its profiling counters, for the life of the object.
class DeviceSession {
 public:
  /// Starts Kokkos with its `--kokkos-*` arguments. Throws `Failure` (usage) for values that Kokkos refuses.
  DeviceSession(device::Backend backend, const std::vector<std::string>& kokkos_arguments);

  /// Prints one notice on standard error if the threads of OpenMP share cores. `program`: name that begins
  /// the line.
  void print_shared_cores(const std::string& program) const;

  /// Fills in backend, device, threads and driver.
  void describe(run::ResultDocument& result) const;

 private:
  device::Backend _backend;
  std::unique_ptr<device::Runtime> _runtime;
};

}  // namespace drogue::framework
