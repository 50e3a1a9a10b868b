#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "miniapps/options/input/chunk.hpp"
#include "miniapps/options/input/row_reader.hpp"

namespace drogue::options_app {

/// Reads the lines of a batch chunk by chunk.
class BatchReader {
 public:
  /// Reads the header. Throws `Failure`: usage for a missing file, invalid_scene for an invalid header.
  BatchReader(const std::filesystem::path& file, RowKind kind);

  /// Replaces the lines of `chunk` by at most `max_lines` further ones, fewer if they are long. Returns false
  /// at the end of the file. Throws `Failure` (io_error).
  bool next(Chunk& chunk, std::size_t max_lines);

  /// Reads the rest of the file. Throws `Failure` (invalid_scene) for a repeated id; lines that cannot be
  /// read are not compared.
  void require_unique_ids();

  /// False if the file has no column of ids: row numbers, which are unique, serve as ids.
  [[nodiscard]] bool has_ids() const { return _columns.front() >= 0; }

  /// Index in a line of each column of `columns_of(kind)`, -1 for an absent one.
  [[nodiscard]] const std::vector<int>& columns() const { return _columns; }

  /// Fraction of the bytes of the file up to the end of the last row read, 0 to 1.
  [[nodiscard]] double share() const { return _lines.share(); }

  /// Number of rows read.
  [[nodiscard]] std::int64_t rows() const { return _rows; }
  [[nodiscard]] const std::filesystem::path& file() const { return _lines.file(); }

 private:
  csv::LineReader _lines;
  RowKind _kind;
  std::vector<int> _columns;
  csv::Line _line;
  std::int64_t _rows = 0, _chunks = 0;
};

/// False for a regular file with at most one row. Throws as the constructor and `next` of `BatchReader`.
[[nodiscard]] bool has_several_rows(const std::filesystem::path& file, RowKind kind);

}  // namespace drogue::options_app
