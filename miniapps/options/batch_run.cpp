#include "miniapps/options/batch_run.hpp"

#include <algorithm>
#include <chrono>

#include "common/program/signals.hpp"

namespace drogue::options_app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t least_chunk = 64, first_surface_chunk = 4096, most_chunk = 65536;
constexpr double wanted_chunk_time = 0.1;  // s: an answer to Ctrl-C, and work enough for a device

/// Strikes of a maturity that go into one chunk share their solves.
std::size_t smallest_chunk(const Command& command) { return std::max(least_chunk, command.strikes.size()); }

std::size_t first_chunk(const Command& command) {
  if (command.chunk > 0) return command.chunk;
  return command.settings.surface ? std::max(first_surface_chunk, command.strikes.size()) : least_chunk;
}

}  // namespace

BatchRun::BatchRun(const Command& command, BatchReader& reader, PriceWriter& writer,
                   std::optional<BoundaryWriter>& boundaries, options::Pricer& pricer)
    : _command(command),
      _reader(reader),
      _writer(writer),
      _boundaries(boundaries),
      _pricer(pricer),
      _progress(command.quiet),
      _chunk(first_chunk(command)) {}

ExitCode BatchRun::run(run::ResultDocument::Timing& timing) {
  const auto begin = Clock::now();
  while (!interrupted() && _reader.next(_rows, _chunk)) {
    for (const Row& row : _rows) add(row);
    flush();
    _progress.update_rows(_writer.tally().rows, _reader.share());
  }
  _progress.finish();
  if (interrupted()) return ExitCode::interrupted;
  if (_boundaries) _boundaries->commit();
  _writer.commit();
  timing.h2d_s += _timing.h2d;
  timing.compute_s += _timing.compute;
  timing.d2h_s += _timing.d2h;
  timing.io_s += std::chrono::duration<double>(Clock::now() - begin).count() - _pricing;
  return ExitCode::ok;
}

void BatchRun::add(const Row& row) {
  const auto put = [&](const options::Contract& contract) {
    if (_owners.size() >= _chunk) flush();
    _owners.push_back(&row);
    _is_valid.push_back(row.fault.empty());
    if (row.fault.empty()) _contracts.push_back(contract);
  };
  if (!row.fault.empty() || _command.action == Action::price) return put(row.contract);
  options::Contract contract = row.contract;
  for (const double maturity : _command.maturities) {
    if (_owners.size() + _command.strikes.size() > _chunk) flush();
    for (const double strike : _command.strikes) {
      contract.maturity = maturity;
      contract.strike = strike;
      put(contract);
      if (interrupted()) return;
    }
  }
}

void BatchRun::flush() {
  _prices.assign(_contracts.size(), {});
  if (!_contracts.empty()) price();
  write();
  _owners.clear();
  _is_valid.clear();
  _contracts.clear();
}

void BatchRun::price() {
  const auto begin = Clock::now();
  const options::Timing timing = _pricer.price(_contracts, _prices);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  _timing.h2d += timing.h2d;
  _timing.compute += timing.compute;
  _timing.d2h += timing.d2h;
  _pricing += seconds;
  choose_chunk(seconds);
}

void BatchRun::write() {
  std::size_t priced = 0;
  for (std::size_t i = 0; i < _owners.size(); ++i) {
    if (!_is_valid[i]) {
      _writer.write_invalid(*_owners[i]);
      continue;
    }
    const options::Contract& contract = _contracts[priced];
    _writer.write(*_owners[i], contract, _prices[priced]);
    if (_boundaries && contract.style == options::Style::american &&
        _prices[priced].outcome != options::Outcome::failed)
      _boundaries->write(_owners[i]->id, _pricer.boundary(contract));
    ++priced;
  }
}

void BatchRun::choose_chunk(double seconds) {
  if (_command.chunk > 0) return;
  if (seconds < 0.5 * wanted_chunk_time) {
    if (_contracts.size() >= _chunk) _chunk = std::min(2 * _chunk, most_chunk);
  } else if (seconds > 2.0 * wanted_chunk_time) {
    _chunk = std::max(_chunk / 2, smallest_chunk(_command));
  }
}

}  // namespace drogue::options_app
