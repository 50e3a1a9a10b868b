#include "miniapps/framework/device_session.hpp"

#include <system_error>

#include "common/program/failure.hpp"
#include "common/program/program.hpp"
#include "kernels/device/host_cores.hpp"
#include "kernels/device/profiling_counters.hpp"

namespace drogue::framework {

device::Backend choose_backend(const std::string& option, int useful_threads) {
  device::Backend backend = device::wanted_backend(option);
  if (option == "auto" && backend == device::Backend::openmp && device::is_present(device::Backend::serial) &&
      (useful_threads == 1 || device::default_threads() == 1 || device::host_cores().allowed == 1))
    backend = device::Backend::serial;
  require_backend(backend);
  return backend;
}

void require_backend(device::Backend backend) {
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
}

DeviceSession::DeviceSession(device::Backend backend, const std::vector<std::string>& kokkos_arguments)
    : _backend(backend), _runtime(with_usage_error([&] {
        try {
          return std::make_unique<device::Runtime>(
              kokkos_arguments, backend == device::Backend::openmp ? device::ThreadWaits::adapted
                                                                   : device::ThreadWaits::as_configured);
        } catch (const std::system_error& refused) {
          throw Failure(ExitCode::io_error, refused.what());
        }
      })) {
  device::start_profiling();
}

void DeviceSession::print_shared_cores(const std::string& program) const {
  if (device::cores_are_shared())
    print_notice(
        program,
        "the threads of OpenMP share their cores: they sleep while they wait, and fewer of them take "
        "part in short loops");
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
