#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/csv/fields.hpp"
#include "common/csv/line_reader.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options_app {

/// One row of a batch; a row with a `fault` cannot be priced.
struct Row {
  std::string id;
  options::Contract contract;
  std::string fault;      ///< a sentence on what is wrong, or empty
  std::int64_t line = 0;  ///< in the file
};

/// What the rows of a file describe.
enum class RowKind {
  contract,       ///< an option: every column
  parameter_set,  ///< of a surface: neither `strike` nor `maturity`
};

/// Reads contracts from a CSV file a few at a time.
class BatchReader {
 public:
  /// Reads the header. Throws Failure: usage for no file, invalid_scene for what is wrong with the header.
  BatchReader(const std::filesystem::path& file, RowKind kind);

  /// Replaces `rows` by up to `most` more. False if there are none. Throws Failure(io_error).
  bool next(std::vector<Row>& rows, std::size_t most);

  /// Throws Failure(invalid_scene) if an id comes twice in the file; reads it from where it stands to the
  /// end.
  void require_unique_ids();

  /// Whether ids are given; if not, they are numbers of rows and need no check.
  [[nodiscard]] bool has_ids() const { return _places.id >= 0; }

  /// What part of the file has been read, 0 .. 1.
  [[nodiscard]] double share() const { return _lines.share(); }
  [[nodiscard]] const std::filesystem::path& file() const { return _lines.file(); }

 private:
  struct Places {
    int id, model, style, type;
    std::vector<int> numbers, parameters;
  };

  void require_columns(std::int64_t header_line) const;
  std::string_view split(const csv::Line& line);
  std::string_view next_id();
  void read_contract(Row& row) const;
  void read_words(Row& row) const;
  void read_parameters(Row& row) const;
  void read_number(Row& row, const char* name, int place, bool required, double& value) const;
  [[nodiscard]] std::string_view field(int place) const;

  csv::LineReader _lines;
  RowKind _kind;
  std::size_t _columns = 0;
  Places _places;
  csv::Fields _fields;
  csv::Line _line;
  std::string _id, _fault;
  std::int64_t _rows = 0;
};

}  // namespace drogue::options_app
