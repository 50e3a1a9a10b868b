#pragma once

#include "miniapps/options/batch_reader.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {

/// Cuts a batch into chunks that take about a tenth of a second each: an answer to Ctrl-C, and work enough
/// for a device. Towards the end of a batch that several ranks share they become smaller, so that no rank
/// waits long for the last one.
class ChunkSource {
 public:
  ChunkSource(const Command& command, BatchReader& reader, int ranks);

  /// False at the end of the batch. Throws Failure(io_error).
  bool next(Chunk& chunk);

  /// Learns from a chunk of `rows` rows that took so long.
  void learn(std::int64_t rows, double seconds);

  /// What part of the file has been read, 0 .. 1.
  [[nodiscard]] double share() const { return _reader.share(); }

 private:
  [[nodiscard]] std::size_t rows_wanted() const;

  BatchReader& _reader;
  bool _is_fixed;
  int _ranks;
  std::size_t _contracts_a_row;
  std::size_t _least;      ///< strikes of a maturity share solves if they are in one chunk
  std::size_t _contracts;  ///< of a chunk
};

}  // namespace drogue::options_app
