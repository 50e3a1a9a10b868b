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

/// Row of a batch.
struct ContractRow {
  std::string id;  ///< empty if the line or its id cannot be read
  options::Contract contract;
  std::string error_message;  ///< reason for which the row is invalid, or empty
  std::int64_t line = 0;      ///< line number in the file
};

/// Content of the rows of a file.
enum class RowKind {
  contract,       ///< an option: all columns
  parameter_set,  ///< a parameter set of a surface: all columns but `strike` and `maturity`
};

/// Converts lines after the header to rows. Does not throw.
class RowReader {
 public:
  /// `columns`: index in a line of each of `columns_of(kind)`, -1 for an absent one.
  RowReader(RowKind kind, const std::vector<int>& columns);

  /// Reads a line as row `number` of its batch, counted from 1. An invalid row has an error message.
  void read(const csv::Line& line, std::int64_t number, ContractRow& row);

  /// Id of that row if the line can be read; valid until the next line is read. The id of an unreadable line
  /// is excluded from the check for repeated ids.
  [[nodiscard]] std::optional<std::string_view> unique_id(const csv::Line& line, std::int64_t number);

 private:
  void split(const csv::Line& line);
  std::string_view read_id(const csv::Line& line, std::int64_t number);
  void read_contract(ContractRow& row) const;
  void read_keywords(ContractRow& row) const;
  void read_parameters(ContractRow& row) const;
  void read_number(ContractRow& row, const char* name, int column, bool required, double& value) const;
  [[nodiscard]] std::string_view field(int column) const;

  RowKind _kind;
  std::size_t _column_count = 0;
  int _id_column, _model_column, _style_column, _type_column;
  std::vector<int> _number_columns, _parameter_columns;
  csv::Fields _fields;
  std::string _id, _line_error;
};

/// Names of the valid columns of a file.
[[nodiscard]] std::vector<std::string> columns_of(RowKind kind);

/// Name, for a message, of the first column that every row requires and that is absent (index -1 in
/// `columns`); empty if there is none.
[[nodiscard]] std::string missing_column(RowKind kind, const std::vector<int>& columns);

}  // namespace drogue::options_app
