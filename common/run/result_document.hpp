#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/program/failure.hpp"

namespace drogue::run {

/// One verified quantity: passed if |value| <= tolerance.
struct Check {
  std::string name;
  double value = 0.0;
  double tolerance = 0.0;
  bool passed = false;
};

/// result.json, schema `drogue.result/1`. A number that is not finite is written as null.
struct ResultDocument {
  std::string program, version, git, scene, backend, device;
  std::string precision = "double";
  std::string driver;  ///< how steps reach the device: "persistent", "graph", "plain", "stages" or "seed"
  int ranks = 1;
  int threads = 1;
  ExitCode exit_code = ExitCode::ok;
  std::string message;
  std::int64_t steps = 0;
  double time = 0.0;                  ///< simulated, s
  double dt_min = 0.0, dt_max = 0.0;  ///< s
  std::map<std::string, double> errors;
  std::vector<Check> checks;
  std::map<std::string, std::int64_t> counts;  ///< of a batch: how many rows ended how; else empty
  std::map<std::string, double> energy;        ///< J, of a run that accounts for it: at its end; else empty
  /// Of what has none, zeros.
  struct Limiter {
    std::int64_t touches = 0;  ///< faces limited, summed over all stages
    std::int64_t cells = 0;    ///< cells that had such a face at least once
    std::int64_t redone_steps = 0;
  } limiter;
  struct Timing {
    double wall_s = 0, setup_s = 0, compute_s = 0, h2d_s = 0, d2h_s = 0, io_s = 0;
  } timing;
  struct Ledger {
    std::int64_t kernel_launches = 0, fences = 0, device_allocations_after_warmup = 0, h2d_bytes = 0,
                 d2h_bytes = 0;
  } ledger;
  struct PeakBytes {
    std::int64_t host = 0, device = 0;
  } peak_bytes;
  struct Provenance {
    std::string compiler, flags, kokkos, cpu, gpu, driver, date;
  } provenance;

  /// Tells what the run is on. `Facts` are those of kernels/device/runtime.hpp, which this layer does not
  /// include.
  template <class Facts>
  void describe_device(const std::string& name_of_backend, const Facts& facts) {
    backend = name_of_backend;
    threads = backend == "openmp" ? facts.threads : 1;
    device = backend == "cuda" ? facts.gpu : provenance.cpu;
    provenance.kokkos = facts.kokkos_version;
    provenance.gpu = facts.gpu;
    provenance.driver = facts.driver;
  }

  /// Tells what the run asked of the device. `Asked` is the Ledger of kernels/device/profiling_counters.hpp.
  template <class Asked>
  void describe_ledger(const Asked& asked) {
    ledger = {asked.kernel_launches, asked.fences, asked.allocations_after_warmup, asked.h2d_bytes,
              asked.d2h_bytes};
    peak_bytes.device = asked.peak_device_bytes;
  }

  /// Adds a check and says whether it passed; a value that is not a number fails.
  bool add_check(const std::string& name, double value, double tolerance);

  /// First check that failed, as the Failure to throw (verification_failed) says it; empty if all passed.
  [[nodiscard]] std::string failed_check() const;
};

/// A document that knows the build, the processor and the date, before anything ran.
ResultDocument new_result(const std::string& program, const std::string& scene);

/// `ok`, `invalid`, `numerical-failure`, ... as the schema names them.
std::string status_name(ExitCode code);

std::string to_json(const ResultDocument& result);

/// Writes `file` atomically, the peak of host memory filled in. Throws Failure(io_error).
void write_result(const std::filesystem::path& file, ResultDocument result);

}  // namespace drogue::run
