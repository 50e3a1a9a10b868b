#include "miniapps/options/input/row_reader.hpp"

#include <algorithm>

#include "common/csv/numbers.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/options/contract_check.hpp"
#include "miniapps/options/input/columns.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t max_id_bytes = 256;

template <class Value, std::size_t count>
bool find_keyword(std::string_view text, const Keyword<Value> (&keywords)[count], Value& value) {
  const auto keyword =
      std::find_if(keywords, keywords + count, [&](const auto& each) { return text == each.text; });
  if (keyword == keywords + count) return false;
  value = keyword->value;
  return true;
}

template <class Value, std::size_t count>
void read_keyword(ContractRow& row, const char* column, std::string_view text,
                  const Keyword<Value> (&keywords)[count], Value& value) {
  if (!row.error_message.empty() || text.empty() || find_keyword(text, keywords, value)) return;
  std::vector<std::string> valid;
  for (const auto& keyword : keywords) valid.emplace_back(keyword.text);
  row.error_message = std::string(column) + " = " + csv::shown(text) + ": " + scene::suggestion(text, valid);
}

bool belongs_to(const NumberColumn& column, RowKind kind) {
  return kind == RowKind::contract ||
         (column.member != &options::Contract::strike && column.member != &options::Contract::maturity);
}

/// Looks up the index of a column by its name; -1 for an absent column.
class ColumnIndex {
 public:
  ColumnIndex(RowKind kind, const std::vector<int>& columns) : _names(columns_of(kind)), _columns(columns) {}

  int operator()(const char* name) const {
    const auto found = std::find(_names.begin(), _names.end(), name);
    return found == _names.end() ? -1 : _columns[static_cast<std::size_t>(found - _names.begin())];
  }

 private:
  std::vector<std::string> _names;
  const std::vector<int>& _columns;
};

}  // namespace

std::vector<std::string> columns_of(RowKind kind) {
  std::vector<std::string> names = input_columns();
  for (const NumberColumn& column : number_columns)
    if (!belongs_to(column, kind)) names.erase(std::find(names.begin(), names.end(), column.name));
  return names;
}

std::string missing_column(RowKind kind, const std::vector<int>& columns) {
  const ColumnIndex column_index(kind, columns);
  const auto quoted = [](const char* name) { return '"' + std::string(name) + '"'; };
  for (const NumberColumn& column : number_columns)
    if (column.required && belongs_to(column, kind) && column_index(column.name) < 0)
      return quoted(column.name);
  if (column_index("model") >= 0) return {};  // the model of each row decides
  for (const ModelParameter& parameter : model_parameters)
    if (parameter.model == options::JumpModel::generalized_hyperbolic && column_index(parameter.name) < 0)
      return quoted(parameter.name) + ", a parameter of gh, the model of rows without a column \"model\"";
  return {};
}

RowReader::RowReader(RowKind kind, const std::vector<int>& columns) : _kind(kind) {
  const ColumnIndex column_index(kind, columns);
  _column_count = static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](int column) { return column >= 0; }));
  _id_column = column_index("id");
  _model_column = column_index("model");
  _style_column = column_index("style");
  _type_column = column_index("type");
  for (const NumberColumn& column : number_columns) _number_columns.push_back(column_index(column.name));
  for (const ModelParameter& parameter : model_parameters)
    _parameter_columns.push_back(column_index(parameter.name));
}

std::string_view RowReader::field(int column) const {
  return column < 0 ? std::string_view() : _fields[static_cast<std::size_t>(column)];
}

/// Splits a line. If it has not one field per column, `_line_error` states the reason, and the fields are
/// those that can be read.
void RowReader::split(const csv::Line& line) {
  _line_error = _fields.split(line.too_long ? std::string_view() : line.text);
  _fields.drop_trailing_empty(_column_count);
  if (line.too_long) {
    _line_error = "the line is longer than " + std::to_string(csv::LineReader::longest) + " bytes";
  } else if (_line_error.empty() && _fields.size() != _column_count) {
    _line_error = "the row has " + std::to_string(_fields.size()) + " fields where the header has " +
                  std::to_string(_column_count);
  }
}

/// Id of a row: its field, or the row number if the field is empty or absent. Empty for an unreadable id,
/// since the row number may be the id of another row. `_line_error` states the error of the line or its id.
std::string_view RowReader::read_id(const csv::Line& line, std::int64_t number) {
  split(line);
  const bool is_cut_off = _id_column >= static_cast<int>(_fields.size());
  const std::string_view given = is_cut_off ? std::string_view() : field(_id_column);
  const bool is_long = given.size() > max_id_bytes;
  if (is_long || std::any_of(given.begin(), given.end(), csv::is_control)) {
    if (_line_error.empty())
      _line_error = is_long ? "the id is longer than " + std::to_string(max_id_bytes) + " bytes"
                            : "the id " + csv::shown(given) + " holds a control character";
    return {};
  }
  const bool has_number = given.empty() && (_id_column < 0 || _line_error.empty());
  if (!has_number) return given;
  _id = std::to_string(number);
  return _id;
}

std::optional<std::string_view> RowReader::unique_id(const csv::Line& line, std::int64_t number) {
  const std::string_view id = read_id(line, number);
  return _line_error.empty() ? std::optional(id) : std::nullopt;
}

void RowReader::read(const csv::Line& line, std::int64_t number, ContractRow& row) {
  row.id = read_id(line, number);
  row.line = line.number;
  row.contract = {};
  row.error_message = _line_error;
  if (row.error_message.empty()) read_contract(row);
}

void RowReader::read_contract(ContractRow& row) const {
  read_keywords(row);
  for (std::size_t i = 0; i < std::size(number_columns); ++i)
    read_number(row, number_columns[i].name, _number_columns[i],
                number_columns[i].required && belongs_to(number_columns[i], _kind),
                row.contract.*number_columns[i].member);
  read_parameters(row);
  if (_kind == RowKind::parameter_set) row.contract.strike = row.contract.spot;  // valid if the spot is
  if (row.error_message.empty()) row.error_message = options::violated_condition(row.contract);
}

void RowReader::read_keywords(ContractRow& row) const {
  read_keyword(row, "model", field(_model_column), models, row.contract.model);
  read_keyword(row, "style", field(_style_column), styles, row.contract.style);
  read_keyword(row, "type", field(_type_column), types, row.contract.type);
}

/// A parameter of another model is an error: its value would be ignored silently.
void RowReader::read_parameters(ContractRow& row) const {
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    if (parameter.model == row.contract.model)
      read_number(row, parameter.name, _parameter_columns[i], true, row.contract.jump[parameter.index]);
  }
  if (!row.error_message.empty() || _model_column < 0) return;
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    const bool own =
        std::any_of(std::begin(model_parameters), std::end(model_parameters), [&](const auto& p) {
          return p.model == row.contract.model && std::string_view(p.name) == parameter.name;
        });
    if (own || field(_parameter_columns[i]).empty()) continue;
    const auto model = std::find_if(std::begin(models), std::end(models),
                                    [&](const auto& keyword) { return keyword.value == row.contract.model; });
    row.error_message =
        std::string(parameter.name) + " must be empty: it is no parameter of the model " + model->text;
    return;
  }
}

void RowReader::read_number(ContractRow& row, const char* name, int column, bool required,
                            double& value) const {
  if (!row.error_message.empty()) return;
  const std::string_view text = field(column);
  if (text.empty()) {
    if (required) row.error_message = std::string(name) + " is empty";
    return;
  }
  switch (csv::parse_number(text, value)) {
    case csv::NumberError::none:
      return;
    case csv::NumberError::no_number:
      row.error_message = std::string(name) + " = " + csv::shown(text) + " is not a number";
      return;
    case csv::NumberError::not_finite:
      row.error_message = std::string(name) + " = " + csv::shown(text) + " is not finite";
  }
}

}  // namespace drogue::options_app
