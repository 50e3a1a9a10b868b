#include "kernels/device/runtime.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#if defined(KOKKOS_ENABLE_OPENMP)
#include <omp.h>
#endif

#include "kernels/device/host_cores.hpp"

namespace drogue::device {

namespace {

bool shared_cores = false;

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

/// Starts `count` threads at once, and ends them. Throws std::system_error (one sentence) if the system
/// refuses one: the library of OpenMP would end the process.
void require_threads(int count) {
  std::atomic<bool> ends = false;
  std::vector<std::thread> threads;
  const auto end_all = [&] {
    ends = true;
    ends.notify_all();
    for (std::thread& thread : threads) thread.join();
  };
  try {
    while (static_cast<int>(threads.size()) < count) threads.emplace_back([&ends] { ends.wait(false); });
  } catch (const std::system_error& refused) {
    end_all();
    throw std::system_error(refused.code(), "of " + std::to_string(count + 1) + " threads only " +
                                                std::to_string(threads.size() + 1) +
                                                " start; OMP_NUM_THREADS gives fewer");
  }
  end_all();
}

bool are_waits_configured() {
  return std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr;
}

int openmp_threads() {
#if defined(KOKKOS_ENABLE_OPENMP)
  return Kokkos::OpenMP().concurrency();
#else
  return 1;
#endif
}

}  // namespace

/// A team of OpenMP threads that sleeps. A thread of GCC's OpenMP that waits spins 300000 times before it
/// sleeps, some 10 ms, during which it may hold the core that the thread it waits for needs; but only 100
/// times if the process has more threads than cores (manual of libgomp, GOMP_SPINCOUNT). No function sets
/// this, and the environment is read before `main`.
class Runtime::ShortWaits {
 public:
  ShortWaits() : _thread([this] { sleep_with_team(); }) {
    std::unique_lock lock(_mutex);
    _changed.wait(lock, [this] { return _has_team; });
  }
  ~ShortWaits() {
    {
      const std::lock_guard lock(_mutex);
      _ends = true;
    }
    _changed.notify_all();
    _thread.join();
  }
  ShortWaits(const ShortWaits&) = delete;
  ShortWaits& operator=(const ShortWaits&) = delete;

 private:
  void sleep_with_team() {
#if defined(KOKKOS_ENABLE_OPENMP)
#pragma omp parallel num_threads(omp_get_num_procs() + 2)
    {
      // The team outlives the region that creates it.
      static_cast<void>(omp_get_thread_num());
    }
#endif
    std::unique_lock lock(_mutex);
    _has_team = true;
    _changed.notify_all();
    _changed.wait(lock, [this] { return _ends; });
  }

  std::mutex _mutex;
  std::condition_variable _changed;
  bool _has_team = false, _ends = false;
  std::thread _thread;
};

int default_threads() {
#if defined(KOKKOS_ENABLE_OPENMP)
  return omp_get_max_threads();
#else
  return 1;
#endif
}

Runtime::Runtime(const std::vector<std::string>& arguments, ThreadWaits waits) {
  Kokkos::Tools::Experimental::set_request_tool_settings_callback(without_global_fences);
  checked_number(arguments, "--kokkos-device-id", "KOKKOS_DEVICE_ID", 0, 1023);
  std::vector<std::string> copies = {"drogue"};
  const bool is_given =
      checked_number(arguments, "--kokkos-num-threads", "KOKKOS_NUM_THREADS", 1, most_threads);
  if (!is_given && default_threads() > most_threads)
    copies.push_back("--kokkos-num-threads=" + std::to_string(most_threads));
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : copies) pointers.push_back(text.data());
  // Suppresses the hint about thread binding at every start; a later --kokkos-* option can re-enable it.
  char quiet[] = "--kokkos-disable-warnings";
  pointers.insert(pointers.begin() + 1, quiet);
  auto count = static_cast<int>(pointers.size());
  pointers.push_back(nullptr);
  // Read before the threads of this process start, which spin for some milliseconds after each loop.
  const bool adapts = waits == ThreadWaits::adapted && !are_waits_configured();
  const HostCores cores = adapts ? host_cores() : HostCores{};
  if (!is_given) require_threads(std::min(default_threads(), most_threads) - 1);
  Kokkos::initialize(count, pointers.data());
  if (!adapts || !are_cores_shared(openmp_threads(), cores)) return;
  _short_waits = std::make_unique<ShortWaits>();
  shared_cores = true;
}

Runtime::~Runtime() {
  shared_cores = false;
  _short_waits.reset();
  Kokkos::finalize();
}

bool cores_are_shared() { return shared_cores; }

std::string kokkos_version() {
  constexpr int version = KOKKOS_VERSION;
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

DeviceFacts device_facts() {
  DeviceFacts facts;
  facts.kokkos_version = kokkos_version();
  facts.threads = openmp_threads();
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
#if defined(KOKKOS_ENABLE_HIP)
  hipDeviceProp_t properties;
  if (hipGetDeviceProperties(&properties, Kokkos::HIP().hip_device()) == hipSuccess) {
    facts.gpu = properties.name;
    facts.capability = properties.gcnArchName;
  }
#endif
  return facts;
}

}  // namespace drogue::device
