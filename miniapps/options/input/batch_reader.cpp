#include "miniapps/options/input/batch_reader.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <utility>

#include "common/csv/fields.hpp"
#include "common/csv/header.hpp"

namespace drogue::options_app {
namespace {

/// Bounds the memory of a rank, which holds a few chunks, for lines of any length.
constexpr std::size_t max_chunk_bytes = std::size_t{8} << 20;

/// Hashes that occur more than once, sorted.
std::vector<std::size_t> repeated_hashes(std::vector<std::size_t> hashes) {
  // Sorting all hashes takes as long as reading the file. Only the few that share a slot of a table are
  // sorted.
  constexpr int slots_per_hash = 16;
  const std::size_t slots = std::bit_ceil(slots_per_hash * (hashes.size() + 1));
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
  _columns = std::move(header.places);
  if (const std::string missing = missing_column(kind, _columns); !missing.empty())
    throw csv::invalid_at(file, header.line, "missing column " + missing);
}

bool BatchReader::next(Chunk& chunk, std::size_t max_lines) {
  chunk.number = _chunks;
  chunk.first_row = _rows + 1;
  chunk.lines.clear();
  chunk.text.clear();
  while (chunk.lines.size() < max_lines && chunk.text.size() < max_chunk_bytes && _lines.next(_line)) {
    chunk.lines.push_back({_line.number, static_cast<std::uint32_t>(_line.text.size()), _line.too_long});
    chunk.text += _line.text;
  }
  if (chunk.lines.empty()) return false;
  ++_chunks;
  _rows += static_cast<std::int64_t>(chunk.lines.size());
  return true;
}

void BatchReader::require_unique_ids() {
  // Eight bytes per row, so that the ids of ten million rows fit into memory. Equal hashes nearly always mean
  // equal ids; a second pass over the file compares those ids themselves.
  const std::hash<std::string_view> hash;
  std::vector<std::size_t> hashes;
  RowReader rows(_kind, _columns);
  while (_lines.next(_line))
    if (const auto id = rows.unique_id(_line, ++_rows)) hashes.push_back(hash(*id));
  const std::vector<std::size_t> repeated = repeated_hashes(std::move(hashes));
  if (repeated.empty()) return;
  std::map<std::string, std::int64_t, std::less<>> first_line;
  BatchReader again(file(), _kind);
  while (again._lines.next(again._line)) {
    const auto id = rows.unique_id(again._line, ++again._rows);
    if (!id || !std::binary_search(repeated.begin(), repeated.end(), hash(*id))) continue;
    const auto [entry, is_new] = first_line.emplace(*id, again._line.number);
    if (!is_new)
      throw csv::invalid_at(file(), again._line.number,
                            "the id " + csv::shown(*id) + " is that of line " +
                                std::to_string(entry->second) + "; every row needs its own");
  }
}

bool has_several_rows(const std::filesystem::path& file, RowKind kind) {
  if (!std::filesystem::is_regular_file(file)) return true;  // what is read of a pipe is gone
  Chunk chunk;
  return BatchReader(file, kind).next(chunk, 2) && chunk.lines.size() > 1;
}

}  // namespace drogue::options_app
