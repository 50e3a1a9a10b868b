#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "kernels/device/profiling_counters.hpp"
#include "kernels/options/pricer.hpp"

namespace drogue::options_app {

/// Numbers of output rows by status, and the first row that is invalid or failed.
struct RowCounts {
  std::int64_t rows = 0, coarse = 0, invalid = 0, failed = 0;
  std::int64_t invalid_points =
      0;  ///< the part of `invalid` that belongs to valid parameter sets of a surface
  std::int64_t invalid_line = 0, failed_line = 0;  ///< line number in the input
  std::string invalid_message;
  double largest_error = std::numeric_limits<double>::quiet_NaN();  ///< stated by a row, of its strike

  /// Number of invalid input rows. Does not throw.
  [[nodiscard]] std::int64_t invalid_inputs() const { return invalid - invalid_points; }

  /// Adds the counts of rows that follow in the output.
  void add(const RowCounts& later);
};

/// Wall times and profiling counters of a worker.
struct WorkerUsage {
  options::WallTimes wall_times;
  device::ProfilingCounters counters;

  /// Sums times and counters, and takes the maximum of peak memory.
  void add(const WorkerUsage& other);
};

/// Formatted output rows of a chunk or a part of it.
struct ResultBatch {
  std::int64_t chunk = 0;  ///< chunk number
  bool ends_chunk = false;
  double chunk_seconds = 0.0;  ///< wall time of the whole chunk, s; set if `ends_chunk`
  RowCounts counts;
  std::string prices, boundaries;  ///< lines of both output files
  bool worker_finished = false;    ///< no rows follow, and the worker takes no further chunk
  WorkerUsage usage;               ///< set if `worker_finished`
};

/// Serializes results for another rank. Does not throw.
[[nodiscard]] std::string to_message(const ResultBatch& batch);

/// Deserializes results. Throws std::out_of_range for a truncated message.
[[nodiscard]] ResultBatch result_batch_from(const std::string& message);

}  // namespace drogue::options_app
