#include "miniapps/options/batch_reader.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <utility>

#include "common/csv/fields.hpp"
#include "common/csv/header.hpp"

namespace drogue::options_app {
namespace {

/// Bytes: of a chunk, that a rank may hold a few of them whatever the lines.
constexpr std::size_t most_of_chunk = std::size_t{8} << 20;

/// Those that come more than once, in order.
std::vector<std::size_t> repeated_of(std::vector<std::size_t> hashes) {
  // To sort all of them takes as long as to read them: only those few are sorted that share a slot.
  constexpr int slots_a_hash = 16;
  const std::size_t slots = std::bit_ceil(slots_a_hash * (hashes.size() + 1));
  const auto slot = [slots](std::size_t hash) { return hash & (slots - 1); };
  std::vector<bool> is_taken(slots), is_shared(slots);
  for (const std::size_t hash : hashes) {
    if (is_taken[slot(hash)]) is_shared[slot(hash)] = true;
    is_taken[slot(hash)] = true;
  }
  std::erase_if(hashes, [&](std::size_t hash) { return !is_shared[slot(hash)]; });
  std::sort(hashes.begin(), hashes.end());
  std::vector<std::size_t> repeated;
  for (std::size_t i = 1; i < hashes.size(); ++i)
    if (hashes[i] == hashes[i - 1]) repeated.push_back(hashes[i]);
  return repeated;
}

}  // namespace

BatchReader::BatchReader(const std::filesystem::path& file, RowKind kind) : _lines(file), _kind(kind) {
  csv::Header header = csv::read_header(_lines, columns_of(kind));
  _places = std::move(header.places);
  if (const char* missing = missing_column(kind, _places))
    throw csv::invalid_at(file, header.line, "missing column \"" + std::string(missing) + '"');
}

bool BatchReader::next(Chunk& chunk, std::size_t most) {
  chunk.number = _chunks;
  chunk.first_row = _rows + 1;
  chunk.lines.clear();
  chunk.text.clear();
  while (chunk.lines.size() < most && chunk.text.size() < most_of_chunk && _lines.next(_line)) {
    chunk.lines.push_back({_line.number, static_cast<std::uint32_t>(_line.text.size()), _line.too_long});
    chunk.text += _line.text;
  }
  if (chunk.lines.empty()) return false;
  ++_chunks;
  _rows += static_cast<std::int64_t>(chunk.lines.size());
  return true;
}

void BatchReader::require_unique_ids() {
  // Eight bytes a row, so that ten million fit: of ids with the same hash, which is nearly always the same
  // id, a second reading says whether they are.
  const std::hash<std::string_view> hash;
  std::vector<std::size_t> hashes;
  RowReader rows(_kind, _places);
  while (_lines.next(_line))
    if (const auto id = rows.own_id(_line, ++_rows)) hashes.push_back(hash(*id));
  const std::vector<std::size_t> repeated = repeated_of(std::move(hashes));
  if (repeated.empty()) return;
  std::map<std::string, std::int64_t, std::less<>> first;
  BatchReader again(file(), _kind);
  while (again._lines.next(again._line)) {
    const auto id = rows.own_id(again._line, ++again._rows);
    if (!id || !std::binary_search(repeated.begin(), repeated.end(), hash(*id))) continue;
    const auto [place, is_new] = first.emplace(*id, again._line.number);
    if (!is_new)
      throw csv::invalid_at(file(), again._line.number,
                            "the id " + csv::shown(*id) + " is that of line " +
                                std::to_string(place->second) + "; every row needs its own");
  }
}

}  // namespace drogue::options_app
