#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drogue::options_app {

/// Line of a chunk. Line ends and blank lines are removed.
struct ChunkLine {
  std::int64_t number = 0;   ///< line number in the file, from 1
  std::uint32_t length = 0;  ///< bytes of the chunk's text
  bool too_long = false;     ///< the line exceeds `LineReader::longest`; its text is left out
};

/// Consecutive lines of a batch that one worker prices.
struct Chunk {
  std::int64_t number = 0;             ///< chunk number, from 0
  std::int64_t first_row = 1;          ///< row number of the first line; the id of a row without one
  std::size_t contracts_per_call = 1;  ///< contracts passed to the pricer in one call
  std::vector<ChunkLine> lines;
  std::string text;  ///< all lines, concatenated
};

/// Serializes a chunk for another rank. Does not throw.
[[nodiscard]] std::string to_message(const Chunk& chunk);

/// Deserializes a chunk. Throws std::out_of_range for a truncated message.
[[nodiscard]] Chunk chunk_from(const std::string& message);

}  // namespace drogue::options_app
