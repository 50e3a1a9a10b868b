#include "perf/clocks/gpu_clocks.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <set>

#include "common/run/statistics.hpp"

namespace drogue::perf {

namespace {

using Device = void*;  ///< nvmlDevice_t

// Constants of nvml.h.
constexpr int success = 0, sm_clock = 1, memory_clock = 2;
constexpr struct {
  unsigned long long bit;
  const char* name;
} reasons[] = {{0x04, "power cap"},
               {0x08, "hardware slowdown"},
               {0x20, "thermal limit"},
               {0x40, "hardware thermal limit"},
               {0x80, "power brake"}};

}  // namespace

/// Loaded library and the GPU in it.
struct GpuClocks::Library {
  void* handle = nullptr;
  Device device = nullptr;
  int (*clock)(Device, int, unsigned*) = nullptr;
  int (*throttling)(Device, unsigned long long*) = nullptr;

  template <class Function>
  bool load(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(handle, name));
    return function != nullptr;
  }

  bool open(const std::string& name, const std::string& address) {
    int (*begin)() = nullptr;
    int (*find)(const char*, Device*) = nullptr;
    handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    return handle != nullptr && load(begin, "nvmlInit_v2") &&
           load(find, "nvmlDeviceGetHandleByPciBusId_v2") && load(clock, "nvmlDeviceGetClockInfo") &&
           load(throttling, "nvmlDeviceGetCurrentClocksThrottleReasons") && begin() == success &&
           find(address.c_str(), &device) == success;
  }
};

GpuClocks::GpuClocks(const std::string& address, const std::string& library) {
  if (address.empty()) return;
  auto opened = std::make_unique<Library>();
  // The library stays loaded: its threads may not end before the process.
  if (opened->open(library, address)) _library = std::move(opened);
}

GpuClocks::~GpuClocks() = default;

std::optional<ClockReading> GpuClocks::read() const {
  ClockReading reading;
  unsigned long long bits = 0;
  if (!_library || _library->clock(_library->device, sm_clock, &reading.sm_mhz) != success ||
      _library->clock(_library->device, memory_clock, &reading.memory_mhz) != success ||
      _library->throttling(_library->device, &bits) != success)
    return std::nullopt;
  for (const auto& reason : reasons)
    if ((bits & reason.bit) != 0) reading.throttled.emplace_back(reason.name);
  return reading;
}

ClockReading summarize(const std::vector<ClockReading>& readings) {
  std::vector<double> sm, memory;
  std::set<std::string> seen;
  for (const ClockReading& reading : readings) {
    sm.push_back(reading.sm_mhz);
    memory.push_back(reading.memory_mhz);
    seen.insert(reading.throttled.begin(), reading.throttled.end());
  }
  return {static_cast<unsigned>(run::median(sm)),
          static_cast<unsigned>(run::median(memory)),
          {seen.begin(), seen.end()}};
}

}  // namespace drogue::perf
