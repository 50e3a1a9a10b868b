#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace drogue::perf {

/// Clocks of a GPU at one time.
struct ClockReading {
  unsigned sm_mhz = 0, memory_mhz = 0;
  std::vector<std::string> throttled;  ///< reasons why the clock is low; empty for none
};

/// Clocks as the management library of the driver (NVML) reports them. It is loaded at run time, so that
/// builds need no header of it and machines without a GPU no library.
class GpuClocks {
 public:
  /// GPU at a PCI address such as "0000:19:00.0". Without the library, or that GPU in it, there are no
  /// readings. Does not throw.
  explicit GpuClocks(const std::string& address, const std::string& library = "libnvidia-ml.so.1");
  ~GpuClocks();
  GpuClocks(const GpuClocks&) = delete;
  GpuClocks& operator=(const GpuClocks&) = delete;

  /// Present clocks, none if they cannot be read. Takes some microseconds. Does not throw.
  [[nodiscard]] std::optional<ClockReading> read() const;

 private:
  struct Library;
  std::unique_ptr<Library> _library;
};

/// Medians of the clocks and all reasons of throttling that were seen. Throws std::invalid_argument without
/// readings.
ClockReading summarize(const std::vector<ClockReading>& readings);

}  // namespace drogue::perf
