#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/program/failure.hpp"

namespace drogue::run {

/// Measured quantity, and the interval in which its check passes; all three in the unit of the quantity.
struct Measurement {
  double value = 0.0;
  double lowest = 0.0, highest = 0.0;
};

/// Verified quantity; passed if |value| <= tolerance.
struct Check {
  std::string name;
  double value = 0.0;
  double tolerance = 0.0;
  bool passed = false;
  /// Quantity whose deviation from a target is `value`.
  std::optional<Measurement> measurement = {};
  std::optional<std::int64_t> rows = {};  ///< of history.csv from which it is computed, if from some
  /// Half width of the 95 % interval of a quantity that is a mean over time, by its scatter, in its unit.
  std::optional<double> error = {};

  /// Measurement as text: "3327.1 in [2670, 3560]", "1551.2, not in [2670, 3560]" or "not measured", if it is
  /// not a number; empty without one.
  [[nodiscard]] std::string measured() const;
};

/// Named numbers and names of a run, in groups. Each group becomes an object of result.json, in the order in
/// which the groups were added; empty groups are left out.
class Metrics {
 public:
  using Value = std::variant<std::int64_t, double, std::string>;
  struct Group {
    std::string name;
    std::vector<std::pair<std::string, Value>> values;
  };

  /// Appends an empty group unless it exists.
  void add_group(const std::string& group);

  /// Sets a value, and adds its group and its name if they are new.
  void set(const std::string& group, const std::string& name, Value value);

  /// A number as integer; 0 if it does not exist or is a text.
  [[nodiscard]] std::int64_t integer(const std::string& group, const std::string& name) const;

  /// A number as real; nothing if it does not exist or is a text.
  [[nodiscard]] std::optional<double> real(const std::string& group, const std::string& name) const;

  [[nodiscard]] const std::vector<Group>& groups() const { return _groups; }

 private:
  [[nodiscard]] Group& at(const std::string& group);

  std::vector<Group> _groups;
};

/// Content of result.json, schema `drogue.result/1`. Non-finite numbers are written as null.
struct ResultDocument {
  std::string program, version, git, scene, backend, device;
  std::string fingerprint;  ///< of what a continuation of the run must have in common with it
  std::string precision = "double";
  std::string driver;  ///< how steps are launched: "persistent", "graph", "plain", "stages" or "seed"
  int ranks = 1;
  int threads = 1;
  ExitCode exit_code = ExitCode::ok;
  std::string message;
  std::int64_t steps = 0;
  double time = 0.0;                  ///< simulated, s
  double dt_min = 0.0, dt_max = 0.0;  ///< s
  std::map<std::string, double> errors;
  std::vector<Check> checks;
  std::vector<std::string> warnings;  ///< sentences on numbers that are not to be trusted
  Metrics metrics;                    ///< limiter counts, energies and the like, after `checks`
  /// Parts of the wall time, s, which do not overlap: `wall_s` is their sum.
  struct WallTimes {
    double wall_s = 0;
    double setup_s = 0;           ///< from the start of the run to its first step, without the other parts
    double compute_s = 0;         ///< steps
    double h2d_s = 0, d2h_s = 0;  ///< copies of the state to the device and back
    double io_s = 0;              ///< all else from the first step to the last file
    double bound_s = 0;           ///< bounds of the stable step
    double verify_s = 0;          ///< checks, with the runs of references
    /// Sum of the phases that a simulation measures itself.
    [[nodiscard]] double phases() const { return compute_s + h2d_s + d2h_s + bound_s; }
  } timing;
  struct ProfilingCounters {
    std::int64_t kernel_launches = 0, fences = 0, device_allocations_after_warmup = 0, h2d_bytes = 0,
                 d2h_bytes = 0;
  } ledger;
  struct PeakBytes {
    std::int64_t host = 0, device = 0;
  } peak_bytes;
  struct Provenance {
    std::string compiler, flags, kokkos, cpu, gpu, driver, date;
  } provenance;

  /// Fills in the profiling counters. `Counters` is device::ProfilingCounters, which this layer does not
  /// include.
  template <class Counters>
  void describe_ledger(const Counters& counters) {
    ledger = {counters.kernel_launches, counters.fences, counters.allocations_after_warmup,
              counters.h2d_bytes, counters.d2h_bytes};
    peak_bytes.device = counters.peak_device_bytes;
  }

  /// Adds a check. Returns true if it passed; NaN fails.
  bool add_check(const std::string& name, double value, double tolerance,
                 const std::optional<Measurement>& measurement = {});

  /// Adds a check of the deviation of a quantity from an expected value, in any one unit: relative to that
  /// value, or itself if that is 0.
  void add_deviation(const std::string& name, double quantity, double expected, double tolerance);

  /// Adds a check of the distance between a quantity and an expected value; all three have any one unit.
  void add_distance(const std::string& name, double quantity, double expected, double tolerance);

  /// States from how many rows of history.csv the last check is computed, and warns of few. `period`: rows in
  /// a period of an oscillation, or 0.
  void state_rows(std::size_t rows, double period = 0.0);

  /// One sentence on the first failed check; empty if all passed.
  [[nodiscard]] std::string failed_check() const;
};

/// Document with the facts of the build, the processor and the date.
ResultDocument new_result(const std::string& program, const std::string& scene);

/// Status of an exit code in the schema: `ok`, `invalid`, `numerical-failure`, ...
std::string status_name(ExitCode code);

std::string to_json(const ResultDocument& result);

/// Stores in `result` how a run failed, and calls `write`. Throws a `Failure` that names both failures if
/// `write` throws one.
void record_failure(ResultDocument& result, const Failure& failure, const std::function<void()>& write);

/// Time of the end, s, if the result.json `file` is of a run that reached it, whether its checks passed or
/// not. Nothing for a file that is absent or unreadable.
[[nodiscard]] std::optional<double> time_of_finished_run(const std::filesystem::path& file);

/// Writes `file` atomically, with the peak of host memory. Throws `Failure` (io_error).
void write_result(const std::filesystem::path& file, ResultDocument result);

}  // namespace drogue::run
