#pragma once

#include "miniapps/options/command.hpp"
#include "miniapps/options/input/batch_reader.hpp"
#include "miniapps/options/output/result_batch.hpp"

namespace drogue::options_app {

/// Divides a batch into chunks of about a tenth of a second each: short enough to respond to Ctrl-C, and
/// large enough to occupy a device. Towards the end of a batch that several ranks share the chunks shrink,
/// which balances the load.
class ChunkSource {
 public:
  /// `ranks`: number of ranks that share the batch. Keeps a reference to `reader`.
  ChunkSource(const Command& command, BatchReader& reader, int ranks);

  /// Reads the next chunk; false at the end of the batch. Throws `Failure` (io_error).
  bool next(Chunk& chunk);

  /// Adapts the chunk size to the wall time, s, of a chunk of `rows` rows.
  void adapt(std::int64_t rows, double seconds);

  /// Fraction of the batch that `written` rows of the output are of, 0 to 1. The rows that are not read yet
  /// are taken to be as long as the others. Does not throw.
  [[nodiscard]] double share(const RowCounts& written) const;

 private:
  [[nodiscard]] std::size_t next_row_count() const;

  BatchReader& _reader;
  bool _is_fixed;  ///< `--chunk` sets the size
  int _ranks;
  std::size_t _contracts_per_row;
  std::size_t _min_contracts;  ///< at least all strikes of a maturity, which share solves within a chunk
  std::size_t _contracts;      ///< contracts per chunk
};

}  // namespace drogue::options_app
