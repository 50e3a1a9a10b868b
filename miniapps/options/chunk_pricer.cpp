#include "miniapps/options/chunk_pricer.hpp"

#include <utility>

#include "common/program/signals.hpp"
#include "kernels/options/contract_check.hpp"
#include "miniapps/options/output/output_files.hpp"

namespace drogue::options_app {
namespace {

/// Size at which results are submitted; the rows of one contract may exceed it.
constexpr std::size_t max_result_bytes = std::size_t{1} << 20;

}  // namespace

ChunkPricer::ChunkPricer(const Command& command, RowKind kind, const std::vector<int>& columns,
                         options::Pricer& pricer, options::SensitivityPricer* sensitivities)
    : _command(command),
      _layout(row_layout(command)),
      _reader(kind, columns),
      _pricer(pricer),
      _sensitivity_pricer(sensitivities) {}

void ChunkPricer::run(WorkQueue& queue) {
  const auto finish = [&] {
    ResultBatch last;
    last.worker_finished = true;
    last.usage = _usage;
    last.usage.counters = device::profiling_counters();
    queue.submit(std::move(last));
  };
  try {
    Chunk chunk;
    while (!interrupted() && queue.next(chunk)) price_chunk(chunk, queue);
  } catch (...) {
    finish();
    throw;
  }
  finish();
}

void ChunkPricer::price_chunk(const Chunk& chunk, WorkQueue& queue) {
  _chunk_time = {};
  _results.chunk = chunk.number;
  _rows.resize(chunk.lines.size());
  std::string_view rest = chunk.text;
  for (std::size_t i = 0; i < _rows.size(); ++i) {
    const ChunkLine& line = chunk.lines[i];
    _reader.read({rest.substr(0, line.length), line.number, line.too_long},
                 chunk.first_row + static_cast<std::int64_t>(i), _rows[i]);
    rest.remove_prefix(line.length);
  }
  for (ContractRow& row : _rows) {
    if (row.error_message.empty() && _command.settings.method == options::Method::baseline &&
        row.contract.model != options::JumpModel::generalized_hyperbolic)
      row.error_message = "--method seed supports only generalized hyperbolic jumps";
    add_row(row, chunk, queue);
    if (_is_stopped) return;
  }
  price_pending(queue);
  if (!_is_stopped) submit(queue, true);
}

void ChunkPricer::add_row(const ContractRow& row, const Chunk& chunk, WorkQueue& queue) {
  const auto add = [&](const options::Contract& contract, std::string_view point_error) {
    if (_pending.size() >= chunk.contracts_per_call) price_pending(queue);
    _pending.push_back({&row, contract.strike, contract.maturity, point_error});
    if (row.error_message.empty() && point_error.empty()) _contracts.push_back(contract);
  };
  if (!row.error_message.empty() || _command.action == Action::price) return add(row.contract, {});
  options::Contract contract = row.contract;
  for (const double maturity : _command.maturities) {
    if (_pending.size() + _command.strikes.size() > chunk.contracts_per_call) price_pending(queue);
    for (const double strike : _command.strikes) {
      contract.maturity = maturity;
      contract.strike = strike;
      // The parameter set is valid, so a violated condition is due to the strike or the maturity.
      add(contract, options::violated_condition(contract));
      if (_is_stopped) return;
    }
  }
}

void ChunkPricer::price_pending(WorkQueue& queue) {
  _is_stopped = interrupted() || queue.is_closed();
  if (_is_stopped) return;
  _prices.assign(_contracts.size(), {});
  _sensitivities.assign(_contracts.size(), {});
  if (!_contracts.empty()) price_contracts();
  std::size_t priced = 0;
  for (const PendingRow& pending : _pending) {
    const ContractRow& row = *pending.row;
    if (!row.error_message.empty()) {
      append_invalid(_results, _layout, row);
      continue;
    }
    if (!pending.point_error.empty()) {
      append_invalid_point(_results, _layout, row, pending.strike, pending.maturity, pending.point_error);
      continue;
    }
    const options::Contract& contract = _contracts[priced];
    const options::Price& price = _prices[priced];
    append_price(_results, _layout, row, contract, price, _sensitivities[priced++]);
    if (!_command.boundary.empty() && contract.style == options::Style::american &&
        price.status != options::PriceStatus::failed)
      append_boundary(_results, row, contract.maturity, boundary_of(contract, price));
    if (_results.prices.size() + _results.boundaries.size() >= max_result_bytes) submit(queue, false);
  }
  _pending.clear();
  _contracts.clear();
}

/// Exercise boundary on the grid of the price. The point at time 0 is taken from the price, from which it may
/// differ by rounding.
std::vector<options::BoundaryPoint> ChunkPricer::boundary_of(const options::Contract& contract,
                                                             const options::Price& price) const {
  std::vector<options::BoundaryPoint> points = _pricer.boundary(contract, price.mesh, price.steps);
  if (!points.empty() && points.front().time == 0.0) points.front().spot = price.exercise_boundary;
  return points;
}

void ChunkPricer::price_contracts() {
  _usage.wall_times.add(_pricer.price(_contracts, _prices));
  if (_sensitivity_pricer != nullptr)
    _usage.wall_times.add(_sensitivity_pricer->compute(_contracts, _prices, _sensitivities));
}

void ChunkPricer::submit(WorkQueue& queue, bool ends_chunk) {
  _results.ends_chunk = ends_chunk;
  if (ends_chunk) _results.chunk_seconds = _chunk_time.seconds();
  const std::int64_t chunk = _results.chunk;
  queue.submit(std::exchange(_results, {}));
  _results.chunk = chunk;
}

}  // namespace drogue::options_app
