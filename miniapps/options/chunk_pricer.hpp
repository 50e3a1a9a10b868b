#pragma once

#include <string_view>
#include <vector>

#include "kernels/options/pricer.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/desk.hpp"
#include "miniapps/options/price_text.hpp"
#include "miniapps/options/row_reader.hpp"

namespace drogue::options_app {

/// Prices chunks of a batch on one rank: what comes in are lines, what goes out are lines.
class BatchRun {
 public:
  /// `places` are those of the batch's BatchReader.
  BatchRun(const Command& command, RowKind kind, const std::vector<int>& places, options::Pricer& pricer);

  /// Prices what there is at the desk until that has no more or a signal comes, and tells it that it leaves,
  /// also where it throws.
  void work(Desk& desk);

 private:
  /// What a row of the prices is of.
  struct Asked {
    const Row* row;
    double strike, maturity;
    std::string_view fault;  ///< a condition that these two break, of a surface; the row's own are in `row`
  };

  void price(const Chunk& chunk, Desk& desk);
  void add(const Row& row, const Chunk& chunk, Desk& desk);
  void flush(Desk& desk);
  [[nodiscard]] std::vector<options::BoundaryPoint> boundary_of(const options::Contract& contract,
                                                                const options::Price& price) const;
  void price_contracts();
  void hand_in(Desk& desk, bool ends_chunk);

  const Command& _command;
  Layout _layout;
  RowReader _reader;
  options::Pricer& _pricer;
  std::vector<Row> _rows;
  std::vector<Asked> _asked;                  ///< a row of the prices each
  std::vector<options::Contract> _contracts;  ///< of those that are valid
  std::vector<options::Price> _prices;
  Piece _piece;
  Spent _spent;
  double _begin = 0.0;  ///< of the chunk
  bool _is_stopped = false;
};

}  // namespace drogue::options_app
