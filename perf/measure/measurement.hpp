#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kernels/device/backend_list.hpp"
#include "perf/clocks/gpu_clocks.hpp"

namespace drogue::perf {

/// Facts of a case for a roofline diagram. Zero or empty: unknown.
struct Facts {
  std::int64_t cells = 0;
  std::string variant = {};  ///< difference from the standard case of this backend and size
  double flops = 0.0;        ///< per unit of work
  double bytes = 0.0;        ///< per unit of work, between kernels and memory
  /// Relative error of a separate run of the solver against an exact solution; 0 without one.
  double solution_error = 0.0;
  /// Least number of arithmetic instructions per unit of work, with every operation fused that can be; on a
  /// GPU of single threads.
  double instructions = 0.0;
  long launches = 0;  ///< kernels per unit of work that wait for one another; 0 within a persistent kernel
  std::string driver = {};  ///< that launches them (`stepping::driver_name`)
  /// Time on a device per unit of work, s (`device_time`): median of some works after the samples. 0 without
  /// a device, and for works that are more than kernels on one stream.
  double device_seconds = 0.0;
  int iterations = 0;  ///< of the last solve by an iterative solver
};

/// Prepared work of a case, which owns what it works on. A timed sample is a reset and a work.
struct Sample {
  std::function<void()> reset;  ///< restores the initial state; not timed
  std::function<long()> work;   ///< returns the number of units of work done
  /// Error of the final state against the reference or an exact solution; called after the last sample.
  std::function<double()> error = {};
  /// Seconds of the named parts of the last work. If present, their sum replaces the wall time.
  std::function<std::map<std::string, double>()> parts = {};
  std::function<void(Facts&)> complete = {};  ///< adds facts after the last sample, if present
};

/// Benchmark case.
struct Case {
  std::string name;          ///< work/variant/size, as `drogue-perf list` prints it
  device::Backend backend;   ///< of the work
  std::string unit_of_work;  ///< divisor of the seconds of a sample, for example "step"
  std::string bound;         ///< the limiting resource, in words
  double tolerance;          ///< largest error of a valid timing
  std::function<Sample()> prepare;
  Facts facts = {};  ///< those that are known before

  /// True if the backend of the work needs a device. Does not throw.
  [[nodiscard]] bool on_device() const { return device::needs_device(backend); }
};

/// Measured case.
struct Record {
  std::string name, unit_of_work, bound;
  device::Backend backend{};
  std::vector<double> samples = {};  ///< seconds per unit of work
  double error = 0.0;
  double tolerance = 0.0;
  std::map<std::string, std::vector<double>> parts = {};  ///< of `samples`, for cases with named parts
  Facts facts = {};
  std::vector<ClockReading> clocks = {};  ///< of the GPU after each sample; empty for cases on a host
  long repeats = 1;                       ///< works of a sample
  long units = 0;                         ///< of work in a sample

  /// True if the error is within the tolerance. Does not throw.
  [[nodiscard]] bool passed() const { return error <= tolerance; }
};

/// Numbers of discarded and of recorded rounds. Warm-up lasts `warm_up_seconds` at least, and twice as long
/// while the clock of a GPU rises: one that idled runs at a fraction of its clock for some tenths of a
/// second.
inline constexpr int warm_up_rounds = 3;
inline constexpr double warm_up_seconds = 1.0;
constexpr int kept_rounds(bool quick) { return quick ? 7 : 25; }
/// Recorded rounds of `run`, whose records a verdict compares: as many as find a change of a tenth at 3 %
/// noise.
inline constexpr int run_rounds = 30;
/// Samples that a case has at least, however long they take.
inline constexpr std::size_t least_samples = 3;
/// Time that a sample of no work takes, s: median of 200 means.
double timer_overhead();

/// Instruments of a measurement beside the clock of the host.
struct Instruments {
  const GpuClocks* clocks = nullptr;  ///< read after each sample of a case on a device
  /// Empties the caches of the device (true) or of the host before each work, outside of its time; each
  /// sample is one work then. Without it caches are warm: as the work before and the initial state leave
  /// them.
  std::function<void(bool on_device)> empty_caches = {};
  /// Time of the samples of a case, s, with what is not timed, after which it takes no part in later rounds:
  /// a table of puts on many meshes would otherwise wait for the longest one.
  double longest_case = 10.0;
};

/// Times `cases` in interleaved rounds of one sample each, so that a disturbance affects all of them.
/// Discards the first `warm_up` rounds, and more until cases on a device and those on a host have each worked
/// for `warm_up_seconds` and the clock of the GPU no longer rises (`WarmUp`), unless `warm_up` is 0; sweeps
/// of caches count as work. A case whose samples have lasted for `Instruments::longest_case` has fewer than
/// `rounds`, but `least_samples`. The warm-up also determines how often a sample repeats its work, to last
/// for `shortest_sample`; each work starts from the initial state. Blocking; passes on exceptions of the
/// cases. After a signal (`interrupted`) it ends with the samples that there are; throws Failure(interrupted)
/// if a case has none.
std::vector<Record> measure(const std::vector<Case>& cases, int warm_up, int rounds,
                            const Instruments& instruments = {});

}  // namespace drogue::perf
