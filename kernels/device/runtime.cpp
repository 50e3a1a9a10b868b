#include "kernels/device/runtime.hpp"

#include <Kokkos_Core.hpp>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#if defined(KOKKOS_ENABLE_OPENMP)
#include <omp.h>
#endif

namespace drogue::device {

namespace {

void without_global_fences(const std::uint32_t, Kokkos_Tools_ToolSettings* settings) {
  settings->requires_global_fencing = false;
}

/// Length of the table of OpenMP threads in Kokkos, which does not check it.
constexpr int most_threads = 512;

void require_number(const std::string& name, std::string_view text, int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && value >= least && value <= most) return;
  throw std::invalid_argument(name + " = " + std::string(text) + " is not an integer between " +
                              std::to_string(least) + " and " + std::to_string(most));
}

/// True if the option or the environment variable is given. Throws std::invalid_argument for a value that is
/// not an integer in the range.
bool checked_number(const std::vector<std::string>& arguments, const std::string& option,
                    const char* variable, int least, int most) {
  bool given = false;
  for (const std::string& argument : arguments) {
    if (!argument.starts_with(option + "=")) continue;
    require_number(option, std::string_view(argument).substr(option.size() + 1), least, most);
    given = true;
  }
  if (const char* text = std::getenv(variable)) {
    require_number(variable, text, least, most);
    given = true;
  }
  return given;
}

int default_threads() {
#if defined(KOKKOS_ENABLE_OPENMP)
  return omp_get_max_threads();
#else
  return 1;
#endif
}

}  // namespace

Runtime::Runtime(const std::vector<std::string>& arguments) {
  Kokkos::Tools::Experimental::set_request_tool_settings_callback(without_global_fences);
  checked_number(arguments, "--kokkos-device-id", "KOKKOS_DEVICE_ID", 0, 1023);
  std::vector<std::string> copies = {"drogue"};
  if (!checked_number(arguments, "--kokkos-num-threads", "KOKKOS_NUM_THREADS", 1, most_threads) &&
      default_threads() > most_threads)
    copies.push_back("--kokkos-num-threads=" + std::to_string(most_threads));
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : copies) pointers.push_back(text.data());
  // Suppresses the hint about thread binding at every start; a later --kokkos-* option can re-enable it.
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
  if (cudaGetDeviceProperties(&properties, Kokkos::Cuda().cuda_device()) == cudaSuccess) {
    facts.gpu = properties.name;
    facts.capability = std::to_string(properties.major) + "." + std::to_string(properties.minor);
  }
  if (cudaDriverGetVersion(&driver) == cudaSuccess)
    facts.driver = std::to_string(driver / 1000) + "." + std::to_string(driver % 1000 / 10);
#endif
  return facts;
}

}  // namespace drogue::device
