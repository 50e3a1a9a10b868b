#pragma once

#include <optional>
#include <vector>

#include "common/program/progress.hpp"
#include "common/run/result_document.hpp"
#include "kernels/options/pricer.hpp"
#include "miniapps/options/batch_reader.hpp"
#include "miniapps/options/boundary_writer.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/price_writer.hpp"

namespace drogue::options_app {

/// Reads, prices and writes a batch a chunk at a time, so that memory does not grow with it.
class BatchRun {
 public:
  BatchRun(const Command& command, BatchReader& reader, PriceWriter& writer,
           std::optional<BoundaryWriter>& boundaries, options::Pricer& pricer);

  /// Prices all rows. Returns `interrupted` after a signal, else `ok`, whatever became of the rows; times are
  /// added to `timing`.
  ExitCode run(run::ResultDocument::Timing& timing);

 private:
  void add(const Row& row);
  void flush();
  void price();
  void write();
  void choose_chunk(double seconds);

  const Command& _command;
  BatchReader& _reader;
  PriceWriter& _writer;
  std::optional<BoundaryWriter>& _boundaries;
  options::Pricer& _pricer;
  ProgressLine _progress;
  options::Timing _timing;
  double _pricing = 0.0;  ///< s
  std::size_t _chunk;
  std::vector<Row> _rows;
  std::vector<const Row*> _owners;  ///< of each contract; of an invalid row there is none
  std::vector<options::Contract> _contracts;
  std::vector<options::Price> _prices;
  std::vector<bool> _is_valid;  ///< of what is to be written, in order
};

}  // namespace drogue::options_app
