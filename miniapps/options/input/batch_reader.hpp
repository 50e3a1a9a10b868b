#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "miniapps/options/chunk.hpp"
#include "miniapps/options/row_reader.hpp"

namespace drogue::options_app {

/// Reads the lines of a batch a chunk at a time.
class BatchReader {
 public:
  /// Reads the header. Throws Failure: usage for no file, invalid_scene for what is wrong with the header.
  BatchReader(const std::filesystem::path& file, RowKind kind);

  /// Replaces the lines of `chunk` by up to `most` more, fewer if they are long. False if there are none.
  /// Throws Failure(io_error).
  bool next(Chunk& chunk, std::size_t most);

  /// Throws Failure(invalid_scene) if an id comes twice in the file; reads it from where it stands to the
  /// end. A line that cannot be read has no say.
  void require_unique_ids();

  /// Whether ids are given; if not, they are numbers of rows and need no check.
  [[nodiscard]] bool has_ids() const { return _places.front() >= 0; }

  /// Of each of the columns of its kind in a line, -1 for none.
  [[nodiscard]] const std::vector<int>& places() const { return _places; }

  /// What part of the file has been read, 0 .. 1.
  [[nodiscard]] double share() const { return _lines.share(); }
  [[nodiscard]] std::int64_t rows() const { return _rows; }
  [[nodiscard]] const std::filesystem::path& file() const { return _lines.file(); }

 private:
  csv::LineReader _lines;
  RowKind _kind;
  std::vector<int> _places;
  csv::Line _line;
  std::int64_t _rows = 0, _chunks = 0;
};

}  // namespace drogue::options_app
