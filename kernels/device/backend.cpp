#include "kernels/device/backend.hpp"

#include <Kokkos_Core.hpp>

namespace drogue::device {

std::string_view name(Backend backend) {
  std::string_view found;
  for_each_backend<KnownBackends>([&](const auto& entry) {
    if (entry.backend == backend) found = entry.name;
  });
  return found;
}

std::optional<Backend> backend_from_name(std::string_view text) {
  std::optional<Backend> found;
  for_each_backend<KnownBackends>([&](const auto& entry) {
    if (entry.name == text) found = entry.backend;
  });
  return found;
}

std::vector<Backend> compiled_backends() {
  std::vector<Backend> backends;
  for_each_backend<CompiledBackends>([&](const auto& entry) { backends.push_back(entry.backend); });
  return backends;
}

namespace {

bool is_compiled(Backend backend) {
  for (const Backend compiled : compiled_backends())
    if (compiled == backend) return true;
  return false;
}

std::string preset_of(Backend backend) {
  std::string_view preset;
  for_each_backend<KnownBackends>([&](const auto& entry) {
    if (entry.backend == backend) preset = entry.preset;
  });
  return std::string(preset);
}

}  // namespace

bool is_present(Backend backend) {
  if (!is_compiled(backend)) return false;
#if defined(KOKKOS_ENABLE_CUDA)
  if (backend == Backend::cuda) {
    int devices = 0;
    return cudaGetDeviceCount(&devices) == cudaSuccess && devices > 0;
  }
#endif
#if defined(KOKKOS_ENABLE_HIP)
  if (backend == Backend::hip) {
    int devices = 0;
    return hipGetDeviceCount(&devices) == hipSuccess && devices > 0;
  }
#endif
  return true;
}

Backend fastest_backend() {
  Backend fastest = compiled_backends().front();
  for (const Backend backend : compiled_backends())
    if (is_present(backend)) fastest = backend;
  return fastest;
}

Backend wanted_backend(std::string_view option) {
  return option == "auto" ? fastest_backend() : backend_from_name(option).value();
}

std::optional<std::string> why_unavailable(Backend backend) {
  const std::string text(name(backend));
  if (!is_compiled(backend))
    return "the backend '" + text + "' is not compiled in; build the preset '" + preset_of(backend) +
           "' to have it";
  if (!is_present(backend))
    return "the backend '" + text +
           "' finds no device; run on a machine with one, or build the preset 'host'";
  // Kokkos initialises every backend it was built with, and fails without a device.
  for (const Backend compiled : compiled_backends()) {
    if (!is_present(compiled))
      return "this build holds the backend '" + std::string(name(compiled)) +
             "' and does not start without a device; build the preset 'host'";
  }
  return std::nullopt;
}

}  // namespace drogue::device
