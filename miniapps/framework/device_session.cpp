#include "miniapps/framework/device_session.hpp"

#include "common/program/failure.hpp"
#include "kernels/device/profiling_counters.hpp"

namespace drogue::framework {

device::Backend choose_backend(const std::string& option) {
  const device::Backend backend = device::wanted_backend(option);
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
  return backend;
}

DeviceSession::DeviceSession(device::Backend backend, const std::vector<std::string>& kokkos_arguments)
    : _backend(backend),
      _runtime(made_as_asked([&] { return std::make_unique<device::Runtime>(kokkos_arguments); })) {
  device::start_profiling();
}

void DeviceSession::describe(run::ResultDocument& result) const {
  result.describe_device(std::string(device::name(_backend)), device::device_facts());
}

}  // namespace drogue::framework
