#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"

/// Ladders for teaching: one problem, solved by rungs that differ in one idea each (docs/lessons/).
namespace drogue::perf::ladder {

/// Work per unit of a ladder, counted from the source of a rung.
struct Work {
  double launches = 0.0;      ///< kernels, or graphs of kernels
  double copies = 0.0;        ///< between host and device
  double copied_bytes = 0.0;  ///< by these copies
  bool pinned = false;        ///< copies use page-locked host memory
  bool overlapped = false;    ///< copies run beside kernels
  double bytes = 0.0;         ///< between kernels and memory
  double flops = 0.0;         ///< additions and multiplications
  double divisions = 0.0;     ///< divisions and square roots
  bool packed = false;        ///< host code works on packs of the widest register
};

/// Measured limits of a backend on this machine.
struct Ceilings {
  double launch = 0.0;     ///< s per launch of an empty kernel, several in a row
  double copy = 0.0;       ///< s per copy of a few bytes to the device, with the wait for its end
  double pageable = 0.0;   ///< B/s of large copies to the device from ordinary memory
  double pinned = 0.0;     ///< B/s from page-locked memory
  double bandwidth = 0.0;  ///< B/s between kernels and memory
  double flops = 0.0;      ///< FP64 operations per s; on a host by packs
  double divisions = 0.0;  ///< FP64 divisions per s; on a host by packs
  int lanes = 1;           ///< doubles per pack
  /// FP64 divisions per s without packs: of a host more than those of a pack over its lanes, since a division
  /// of a pack takes longer than one of a number.
  double scalar_divisions = 0.0;
};

/// Time that a model expects, and the resource that takes most of it.
struct Prediction {
  double seconds = 0.0;
  const char* bound = "";
};

/// Launches and copies one after the other, then the longer one of memory and arithmetic. Host code without
/// packs uses one lane, and the divider for numbers. Does not throw.
[[nodiscard]] Prediction predict(const Work& work, const Ceilings& ceilings);

/// Measures the ceilings of a backend within about a second. Requires an initialised runtime. Blocking.
/// Throws std::invalid_argument for a backend that is not compiled in.
[[nodiscard]] Ceilings measure_ceilings(device::Backend backend);

/// Rung with its memory on a backend. Requires an initialised runtime. Functions block; they throw only what
/// a failed kernel throws.
class RungRun {
 public:
  virtual ~RungRun() = default;

  /// Restores the initial state.
  virtual void reset() = 0;

  /// Does all units of work, from the initial state to the result.
  virtual void run() = 0;

  /// Difference of the result from the reference of the ladder, relative.
  [[nodiscard]] virtual double error() = 0;
};

/// Text of a rung for its reader.
struct RungText {
  const char* name;
  const char* idea;       ///< a sentence
  const char* hindsight;  ///< what the prediction missed
};

/// Rung of a ladder on one backend.
struct Rung {
  RungText text;
  Work work;               ///< per unit
  double tolerance = 0.0;  ///< largest error of a valid rung
  bool available = true;   ///< false on a host for ideas of GPUs
  std::function<std::unique_ptr<RungRun>()> make;
};

/// Ladder on one backend.
struct Ladder {
  std::string name;
  std::string unit;       ///< of work, for example "step"
  std::string problem;    ///< a line
  std::int64_t size = 0;  ///< cells, vertices, values or options
  long units = 1;         ///< units of work per run
  std::vector<Rung> rungs;
};

/// Names of the ladders. Does not throw.
[[nodiscard]] std::vector<std::string> names();

/// Ladder of that name; `small` selects a size for tests. Allocates nothing on the backend. Throws
/// std::invalid_argument for an unknown name and for a backend that is not compiled in.
[[nodiscard]] Ladder create_ladder(const std::string& name, device::Backend backend, bool small);

}  // namespace drogue::perf::ladder
