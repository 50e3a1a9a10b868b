#include "miniapps/options/input/chunk_source.hpp"

#include <algorithm>

namespace drogue::options_app {
namespace {

constexpr std::size_t min_chunk = 16, first_surface_chunk = 4096, max_chunk = 65536;  // contracts
constexpr std::size_t min_last_chunk = 1024;  // contracts; lower bound for load balancing
constexpr double target_chunk_time = 0.1;     // s

}  // namespace

ChunkSource::ChunkSource(const Command& command, BatchReader& reader, int ranks)
    : _reader(reader),
      _is_fixed(command.chunk > 0),
      _ranks(ranks),
      _contracts_per_row(
          command.action == Action::surface ? command.strikes.size() * command.maturities.size() : 1),
      _min_contracts(std::max(min_chunk, command.strikes.size())),
      _contracts(_is_fixed                  ? command.chunk
                 : command.settings.surface ? std::max(first_surface_chunk, _min_contracts)
                                            : min_chunk) {}

bool ChunkSource::next(Chunk& chunk) {
  chunk.contracts_per_call = _contracts;
  return _reader.next(chunk, next_row_count());
}

double ChunkSource::share(const RowCounts& written) const {
  if (_reader.rows() == 0) return 0.0;
  const std::int64_t invalid = written.invalid_inputs();
  const double priced = static_cast<double>(written.rows - invalid) / static_cast<double>(_contracts_per_row);
  return _reader.share() * (static_cast<double>(invalid) + priced) / static_cast<double>(_reader.rows());
}

std::size_t ChunkSource::next_row_count() const {
  const std::size_t rows = std::max<std::size_t>(_contracts / _contracts_per_row, 1);
  const double share = _reader.share();
  if (_is_fixed || _ranks == 1 || share == 0.0) return rows;
  const double remaining = static_cast<double>(_reader.rows()) * (1.0 - share) / share;
  const auto balanced = static_cast<std::size_t>(remaining / (4.0 * _ranks));
  return std::min(rows, std::max(balanced, min_last_chunk / std::min(_contracts_per_row, min_last_chunk)));
}

void ChunkSource::adapt(std::int64_t rows, double seconds) {
  if (_is_fixed) return;
  if (seconds < 0.5 * target_chunk_time) {
    if ((static_cast<std::size_t>(rows) + 1) * _contracts_per_row > _contracts)
      _contracts = std::min(2 * _contracts, max_chunk);
  } else if (seconds > 2.0 * target_chunk_time) {
    _contracts = std::max(_contracts / 2, _min_contracts);
  }
}

}  // namespace drogue::options_app
