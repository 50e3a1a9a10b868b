#include "kernels/device/runtime.hpp"

#include <Kokkos_Core.hpp>

namespace drogue::device {

namespace {

void without_global_fences(const std::uint32_t, Kokkos_Tools_ToolSettings* settings) {
  settings->requires_global_fencing = false;
}

}  // namespace

Runtime::Runtime(const std::vector<std::string>& arguments) {
  Kokkos::Tools::Experimental::set_request_tool_settings_callback(without_global_fences);
  std::vector<std::string> copies = {"drogue"};
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : copies) pointers.push_back(text.data());
  // A hint about thread binding before every run would drown the one line that matters; --kokkos-* options
  // come later and may bring it back.
  char quiet[] = "--kokkos-disable-warnings";
  pointers.insert(pointers.begin() + 1, quiet);
  auto count = static_cast<int>(pointers.size());
  pointers.push_back(nullptr);
  Kokkos::initialize(count, pointers.data());
}

Runtime::~Runtime() { Kokkos::finalize(); }

std::string kokkos_version() {
  constexpr int version = KOKKOS_VERSION;
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

DeviceFacts device_facts() {
  DeviceFacts facts;
  facts.kokkos_version = kokkos_version();
#if defined(KOKKOS_ENABLE_OPENMP)
  facts.threads = Kokkos::OpenMP().concurrency();
#endif
#if defined(KOKKOS_ENABLE_CUDA)
  cudaDeviceProp properties;
  int driver = 0;
  if (cudaGetDeviceProperties(&properties, Kokkos::Cuda().cuda_device()) == cudaSuccess)
    facts.gpu = properties.name;
  if (cudaDriverGetVersion(&driver) == cudaSuccess)
    facts.driver = std::to_string(driver / 1000) + "." + std::to_string(driver % 1000 / 10);
#endif
  return facts;
}

}  // namespace drogue::device
