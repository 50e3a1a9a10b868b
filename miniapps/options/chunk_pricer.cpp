#include "miniapps/options/batch_run.hpp"

#include <chrono>
#include <utility>

#include "common/program/signals.hpp"
#include "kernels/options/contract_check.hpp"
#include "miniapps/options/outputs.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t most_of_piece = std::size_t{1} << 20;  // of a piece, but for one row's

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

BatchRun::BatchRun(const Command& command, RowKind kind, const std::vector<int>& places,
                   options::Pricer& pricer)
    : _command(command), _layout(layout_of(command)), _reader(kind, places), _pricer(pricer) {}

void BatchRun::work(Desk& desk) {
  const auto leave = [&] {
    Piece last;
    last.leaves = true;
    last.spent = _spent;
    last.spent.ledger = device::profiling_counters();
    desk.hand_in(std::move(last));
  };
  try {
    Chunk chunk;
    while (!interrupted() && desk.next(chunk)) price(chunk, desk);
  } catch (...) {
    leave();
    throw;
  }
  leave();
}

void BatchRun::price(const Chunk& chunk, Desk& desk) {
  _begin = now();
  _piece.chunk = chunk.number;
  _rows.resize(chunk.lines.size());
  std::string_view rest = chunk.text;
  for (std::size_t i = 0; i < _rows.size(); ++i) {
    const ChunkLine& line = chunk.lines[i];
    _reader.read({rest.substr(0, line.length), line.number, line.too_long},
                 chunk.first_row + static_cast<std::int64_t>(i), _rows[i]);
    rest.remove_prefix(line.length);
  }
  for (Row& row : _rows) {
    if (row.fault.empty() && _command.settings.method == options::Method::seed &&
        row.contract.model != options::Model::generalized_hyperbolic)
      row.fault = "--method seed has generalized hyperbolic jumps alone";
    add(row, chunk, desk);
    if (_is_stopped) return;
  }
  flush(desk);
  if (!_is_stopped) hand_in(desk, true);
}

void BatchRun::add(const Row& row, const Chunk& chunk, Desk& desk) {
  const auto put = [&](const options::Contract& contract, std::string_view fault) {
    if (_asked.size() >= chunk.together) flush(desk);
    _asked.push_back({&row, contract.strike, contract.maturity, fault});
    if (row.fault.empty() && fault.empty()) _contracts.push_back(contract);
  };
  if (!row.fault.empty() || _command.action == Action::price) return put(row.contract, {});
  options::Contract contract = row.contract;
  for (const double maturity : _command.maturities) {
    if (_asked.size() + _command.strikes.size() > chunk.together) flush(desk);
    for (const double strike : _command.strikes) {
      contract.maturity = maturity;
      contract.strike = strike;
      // The row breaks none, so what is broken here its strike or maturity breaks.
      put(contract, options::violated_condition(contract));
      if (_is_stopped) return;
    }
  }
}

void BatchRun::flush(Desk& desk) {
  _is_stopped = interrupted() || desk.is_closed();
  if (_is_stopped) return;
  _prices.assign(_contracts.size(), {});
  if (!_contracts.empty()) price_contracts();
  std::size_t priced = 0;
  for (const Asked& asked : _asked) {
    const Row* const row = asked.row;
    if (!row->fault.empty()) {
      append_invalid(_piece, _layout, *row);
      continue;
    }
    if (!asked.fault.empty()) {
      append_invalid_point(_piece, *row, asked.strike, asked.maturity, asked.fault);
      continue;
    }
    const options::Contract& contract = _contracts[priced];
    const options::Price& price = _prices[priced++];
    append_price(_piece, _layout, *row, contract, price);
    if (!_command.boundary.empty() && contract.style == options::Style::american &&
        price.outcome != options::Outcome::failed)
      append_boundary(_piece, *row, boundary_of(contract, price));
    if (_piece.prices.size() + _piece.boundaries.size() >= most_of_piece) hand_in(desk, false);
  }
  _asked.clear();
  _contracts.clear();
}

/// The boundary on the price's own grid. What it says of now is the price's, which another order of
/// operations may have rounded otherwise.
std::vector<options::BoundaryPoint> BatchRun::boundary_of(const options::Contract& contract,
                                                          const options::Price& price) const {
  std::vector<options::BoundaryPoint> points = _pricer.boundary_on(contract, price.mesh, price.steps);
  if (!points.empty() && points.front().time == 0.0) points.front().spot = price.exercise_boundary;
  return points;
}

void BatchRun::price_contracts() {
  const double begin = now();
  const options::WallTimes timing = _pricer.price(_contracts, _prices);
  _spent.timing.h2d += timing.h2d;
  _spent.timing.compute += timing.compute;
  _spent.timing.d2h += timing.d2h;
  _spent.pricing += now() - begin;
}

void BatchRun::hand_in(Desk& desk, bool ends_chunk) {
  _piece.ends_chunk = ends_chunk;
  if (ends_chunk) _piece.seconds = now() - _begin;
  const std::int64_t chunk = _piece.chunk;
  desk.hand_in(std::exchange(_piece, {}));
  _piece.chunk = chunk;
}

}  // namespace drogue::options_app
