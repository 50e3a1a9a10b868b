#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/device/profiling_counters.hpp"
#include "kernels/options/pricer.hpp"

namespace drogue::options_app {

/// A line of a chunk, its end and blank lines between it and the one before taken off.
struct ChunkLine {
  std::int64_t number = 0;  ///< in the file
  std::uint32_t length = 0;
  bool too_long = false;  ///< then its text is left out
};

/// Lines of a batch that one rank prices at a time.
struct Chunk {
  std::int64_t number = 0;     ///< of the chunk, from 0
  std::int64_t first_row = 1;  ///< of the batch: what the row is called if it has no id
  std::size_t together = 1;    ///< contracts priced at a time
  std::vector<ChunkLine> lines;
  std::string text;  ///< all lines, one behind the other
};

/// How many rows ended how, and the first of those that did not end well.
struct Tally {
  std::int64_t rows = 0, coarse = 0, invalid = 0, failed = 0;
  std::int64_t invalid_points = 0;  ///< of the invalid ones: of valid parameter sets of a surface
  std::int64_t invalid_line = 0, failed_line = 0;
  std::string invalid_fault;

  /// Adds rows that stand behind the own ones.
  void add(const Tally& later);
};

/// What a rank spent on its chunks.
struct Spent {
  options::WallTimes timing;
  double pricing = 0.0;  ///< s
  device::ProfilingCounters ledger;

  void add(const Spent& other);
};

/// Rows of the outputs as they stand there, of a chunk or a part of it.
struct Piece {
  std::int64_t chunk = 0;
  bool ends_chunk = false;
  double seconds = 0.0;  ///< that the chunk took; of the piece that ends it
  Tally tally;
  std::string prices, boundaries;
  bool leaves = false;  ///< no rows: the rank takes no further chunk
  Spent spent;          ///< by a rank that leaves
};

// What goes from rank to rank. Throws std::out_of_range for bytes that are no such thing.
[[nodiscard]] std::string to_message(const Chunk& chunk);
[[nodiscard]] std::string to_message(const Piece& piece);
[[nodiscard]] Chunk chunk_from(const std::string& message);
[[nodiscard]] Piece piece_from(const std::string& message);

}  // namespace drogue::options_app
