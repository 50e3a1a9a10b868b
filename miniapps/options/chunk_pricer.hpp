#pragma once

#include <string_view>
#include <vector>

#include "common/program/stopwatch.hpp"
#include "kernels/options/pricer.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/input/row_reader.hpp"
#include "miniapps/options/output/price_rows.hpp"
#include "miniapps/options/parallel/work_queue.hpp"

namespace drogue::options_app {

/// Prices the chunks of a batch on one rank: parses their lines, prices the contracts, formats the output
/// rows.
class ChunkPricer {
 public:
  /// `columns`: column indices of the batch, from its `BatchReader`. Keeps references to all but them.
  /// `sensitivities`: null without Greeks.
  ChunkPricer(const Command& command, RowKind kind, const std::vector<int>& columns, options::Pricer& pricer,
              options::SensitivityPricer* sensitivities);

  /// Prices the chunks of `queue`. Blocks until the queue ends or a signal arrives. Reports the end of the
  /// worker to the queue, also if it throws.
  void run(WorkQueue& queue);

 private:
  /// Row of prices that is not written yet.
  struct PendingRow {
    const ContractRow* row;
    double strike, maturity;
    std::string_view point_error;  ///< condition that this strike or maturity of a surface violates, or empty
  };

  void price_chunk(const Chunk& chunk, WorkQueue& queue);
  void add_row(const ContractRow& row, const Chunk& chunk, WorkQueue& queue);
  void price_pending(WorkQueue& queue);
  [[nodiscard]] std::vector<options::BoundaryPoint> boundary_of(const options::Contract& contract,
                                                                const options::Price& price) const;
  void price_contracts();
  void submit(WorkQueue& queue, bool ends_chunk);

  const Command& _command;
  RowLayout _layout;
  RowReader _reader;
  options::Pricer& _pricer;
  options::SensitivityPricer* _sensitivity_pricer;
  std::vector<ContractRow> _rows;
  std::vector<PendingRow> _pending;
  std::vector<options::Contract> _contracts;  ///< the valid contracts of the pending rows, in order
  std::vector<options::Price> _prices;
  std::vector<options::Sensitivities> _sensitivities;
  ResultBatch _results;
  WorkerUsage _usage;
  Stopwatch _chunk_time;
  bool _is_stopped = false;
};

}  // namespace drogue::options_app
