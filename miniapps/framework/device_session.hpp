#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/run/result_document.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"

namespace drogue::framework {

/// Backend for the value of `--backend`. Throws `Failure` (no_backend) if it is not compiled in or no device
/// is present.
[[nodiscard]] device::Backend choose_backend(const std::string& option);

/// Kokkos and its profiling counters, for the life of the object.
class DeviceSession {
 public:
  /// Starts Kokkos with its `--kokkos-*` arguments. Throws `Failure` (usage) for values that Kokkos refuses.
  DeviceSession(device::Backend backend, const std::vector<std::string>& kokkos_arguments);

  /// Fills in backend, device, threads and driver.
  void describe(run::ResultDocument& result) const;

 private:
  device::Backend _backend;
  std::unique_ptr<device::Runtime> _runtime;
};

}  // namespace drogue::framework
