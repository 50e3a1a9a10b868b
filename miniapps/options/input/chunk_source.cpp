#include "miniapps/options/chunk_source.hpp"

#include <algorithm>

namespace drogue::options_app {
namespace {

constexpr std::size_t least_chunk = 16, first_surface_chunk = 4096, most_chunk = 65536;
constexpr std::size_t least_last_chunk = 1024;  // of those that become smaller
constexpr double wanted_chunk_time = 0.1;       // s

}  // namespace

ChunkSource::ChunkSource(const Command& command, BatchReader& reader, int ranks)
    : _reader(reader),
      _is_fixed(command.chunk > 0),
      _ranks(ranks),
      _contracts_a_row(command.action == Action::surface ? command.strikes.size() * command.maturities.size()
                                                         : 1),
      _least(std::max(least_chunk, command.strikes.size())),
      _contracts(_is_fixed                  ? command.chunk
                 : command.settings.surface ? std::max(first_surface_chunk, _least)
                                            : least_chunk) {}

bool ChunkSource::next(Chunk& chunk) {
  chunk.together = _contracts;
  return _reader.next(chunk, rows_wanted());
}

std::size_t ChunkSource::rows_wanted() const {
  const std::size_t rows = std::max<std::size_t>(_contracts / _contracts_a_row, 1);
  const double share = _reader.share();
  if (_is_fixed || _ranks == 1 || share == 0.0) return rows;
  const double left = static_cast<double>(_reader.rows()) * (1.0 - share) / share;
  const auto fair = static_cast<std::size_t>(left / (4.0 * _ranks));
  return std::min(rows, std::max(fair, least_last_chunk / std::min(_contracts_a_row, least_last_chunk)));
}

void ChunkSource::learn(std::int64_t rows, double seconds) {
  if (_is_fixed) return;
  if (seconds < 0.5 * wanted_chunk_time) {
    if ((static_cast<std::size_t>(rows) + 1) * _contracts_a_row > _contracts)
      _contracts = std::min(2 * _contracts, most_chunk);
  } else if (seconds > 2.0 * wanted_chunk_time) {
    _contracts = std::max(_contracts / 2, _least);
  }
}

}  // namespace drogue::options_app
