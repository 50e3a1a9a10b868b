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
      _runtime(with_usage_error([&] { return std::make_unique<device::Runtime>(kokkos_arguments); })) {
  device::start_profiling();
}

void DeviceSession::describe(run::ResultDocument& result) const {
  const device::DeviceFacts facts = device::device_facts();
  result.backend = device::name(_backend);
  result.threads = _backend == device::Backend::openmp ? facts.threads : 1;
  result.device = device::needs_device(_backend) ? facts.gpu : result.provenance.cpu;
  result.provenance.kokkos = facts.kokkos_version;
  result.provenance.gpu = facts.gpu;
  result.provenance.driver = facts.driver;
}

}  // namespace drogue::framework
