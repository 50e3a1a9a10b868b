#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/csv/fields.hpp"
#include "common/csv/line_reader.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options_app {

/// One row of a batch; a row with a `fault` cannot be priced.
struct Row {
  std::string id;  ///< empty where the line or its id cannot be read
  options::Contract contract;
  std::string fault;      ///< a sentence on what is wrong, or empty
  std::int64_t line = 0;  ///< in the file
};

/// What the rows of a file describe.
enum class RowKind {
  contract,       ///< an option: every column
  parameter_set,  ///< of a surface: neither `strike` nor `maturity`
};

/// Makes rows of the lines behind a header.
class RowReader {
 public:
  /// `places`: of each of `columns_of(kind)` in a line, -1 for none.
  RowReader(RowKind kind, const std::vector<int>& places);

  /// The row of a line, which is the `number`th of its batch.
  void read(const csv::Line& line, std::int64_t number, Row& row);

  /// The id of that row alone, which no other row may have; valid until the next line is read. None of a
  /// line that cannot be read: what seems to be its id refuses no other row.
  [[nodiscard]] std::optional<std::string_view> own_id(const csv::Line& line, std::int64_t number);

 private:
  void split(const csv::Line& line);
  std::string_view read_id(const csv::Line& line, std::int64_t number);
  void read_contract(Row& row) const;
  void read_words(Row& row) const;
  void read_parameters(Row& row) const;
  void read_number(Row& row, const char* name, int place, bool required, double& value) const;
  [[nodiscard]] std::string_view field(int place) const;

  RowKind _kind;
  std::size_t _columns = 0;
  int _id_place, _model, _style, _type;
  std::vector<int> _numbers, _parameters;
  csv::Fields _fields;
  std::string _id, _fault;
};

/// The names that a header of such a file may hold.
[[nodiscard]] std::vector<std::string> columns_of(RowKind kind);

/// The first column that every row of the file needs and that has no place; null if there is none.
[[nodiscard]] const char* missing_column(RowKind kind, const std::vector<int>& places);

}  // namespace drogue::options_app
