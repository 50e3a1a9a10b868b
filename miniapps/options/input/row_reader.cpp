#include "miniapps/options/row_reader.hpp"

#include <algorithm>

#include "common/csv/numbers.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/options/contract_check.hpp"
#include "miniapps/options/columns.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t longest_id = 256;

template <class Value, std::size_t count>
bool find_word(std::string_view text, const Word<Value> (&words)[count], Value& value) {
  const auto word = std::find_if(words, words + count, [&](const auto& each) { return text == each.text; });
  if (word == words + count) return false;
  value = word->value;
  return true;
}

template <class Value, std::size_t count>
void read_word(Row& row, const char* column, std::string_view text, const Word<Value> (&words)[count],
               Value& value) {
  if (!row.fault.empty() || text.empty() || find_word(text, words, value)) return;
  std::vector<std::string> valid;
  for (const auto& word : words) valid.emplace_back(word.text);
  row.fault = std::string(column) + " = " + csv::shown(text) + ": " + scene::suggestion(text, valid);
}

bool belongs_to(const NumberColumn& column, RowKind kind) {
  return kind == RowKind::contract ||
         (column.member != &options::Contract::strike && column.member != &options::Contract::maturity);
}

/// Finds the place of a column by its name; -1 for a column that is not there.
class PlaceOf {
 public:
  PlaceOf(RowKind kind, const std::vector<int>& places) : _names(columns_of(kind)), _places(places) {}

  int operator()(const char* name) const {
    const auto found = std::find(_names.begin(), _names.end(), name);
    return found == _names.end() ? -1 : _places[static_cast<std::size_t>(found - _names.begin())];
  }

 private:
  std::vector<std::string> _names;
  const std::vector<int>& _places;
};

}  // namespace

std::vector<std::string> columns_of(RowKind kind) {
  std::vector<std::string> names = input_columns();
  for (const NumberColumn& column : number_columns)
    if (!belongs_to(column, kind)) names.erase(std::find(names.begin(), names.end(), column.name));
  return names;
}

const char* missing_column(RowKind kind, const std::vector<int>& places) {
  const PlaceOf place(kind, places);
  for (const NumberColumn& column : number_columns)
    if (column.required && belongs_to(column, kind) && place(column.name) < 0) return column.name;
  if (place("model") >= 0) return nullptr;  // each row needs those of its model
  for (const ModelParameter& parameter : model_parameters)
    if (parameter.model == options::Model::generalized_hyperbolic && place(parameter.name) < 0)
      return parameter.name;
  return nullptr;
}

RowReader::RowReader(RowKind kind, const std::vector<int>& places) : _kind(kind) {
  const PlaceOf place(kind, places);
  _columns =
      static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [](int p) { return p >= 0; }));
  _id_place = place("id");
  _model = place("model");
  _style = place("style");
  _type = place("type");
  for (const NumberColumn& column : number_columns) _numbers.push_back(place(column.name));
  for (const ModelParameter& parameter : model_parameters) _parameters.push_back(place(parameter.name));
}

std::string_view RowReader::field(int place) const {
  return place < 0 ? std::string_view() : _fields[static_cast<std::size_t>(place)];
}

/// Splits a line of as many fields as there are columns; else `_fault` says what is wrong, and the fields are
/// those that can be read.
void RowReader::split(const csv::Line& line) {
  _fault = _fields.split(line.too_long ? std::string_view() : line.text);
  if (line.too_long) {
    _fault = "the line is longer than " + std::to_string(csv::LineReader::longest) + " bytes";
  } else if (_fault.empty() && _fields.size() != _columns) {
    _fault = "the row has " + std::to_string(_fields.size()) + " fields where the header has " +
             std::to_string(_columns);
  }
}

/// What stands there, the row's number where nothing does, or nothing where that cannot be read: the number
/// may be another row's id. `_fault` says what is wrong with the line or its id.
std::string_view RowReader::read_id(const csv::Line& line, std::int64_t number) {
  split(line);
  const bool is_cut_off = _id_place >= static_cast<int>(_fields.size());
  const std::string_view given = is_cut_off ? std::string_view() : field(_id_place);
  const bool is_long = given.size() > longest_id;
  if (is_long || std::any_of(given.begin(), given.end(), csv::is_control)) {
    if (_fault.empty())
      _fault = is_long ? "the id is longer than " + std::to_string(longest_id) + " bytes"
                       : "the id " + csv::shown(given) + " holds a control character";
    return {};
  }
  const bool has_number = given.empty() && (_id_place < 0 || _fault.empty());
  if (!has_number) return given;
  _id = std::to_string(number);
  return _id;
}

std::optional<std::string_view> RowReader::own_id(const csv::Line& line, std::int64_t number) {
  const std::string_view id = read_id(line, number);
  return _fault.empty() ? std::optional(id) : std::nullopt;
}

void RowReader::read(const csv::Line& line, std::int64_t number, Row& row) {
  row.id = read_id(line, number);
  row.line = line.number;
  row.contract = {};
  row.fault = _fault;
  if (row.fault.empty()) read_contract(row);
}

void RowReader::read_contract(Row& row) const {
  read_words(row);
  for (std::size_t i = 0; i < std::size(number_columns); ++i)
    read_number(row, number_columns[i].name, _numbers[i],
                number_columns[i].required && belongs_to(number_columns[i], _kind),
                row.contract.*number_columns[i].member);
  read_parameters(row);
  if (_kind == RowKind::parameter_set) row.contract.strike = row.contract.spot;  // breaks none of its own
  if (row.fault.empty()) row.fault = options::violated_condition(row.contract);
}

void RowReader::read_words(Row& row) const {
  read_word(row, "model", field(_model), models, row.contract.model);
  read_word(row, "style", field(_style), styles, row.contract.style);
  read_word(row, "type", field(_type), types, row.contract.type);
}

/// A parameter of another model than the row's is an error: its value would be passed over in silence.
void RowReader::read_parameters(Row& row) const {
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    if (parameter.model == row.contract.model)
      read_number(row, parameter.name, _parameters[i], true, row.contract.jump[parameter.place]);
  }
  if (!row.fault.empty() || _model < 0) return;
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    const bool own =
        std::any_of(std::begin(model_parameters), std::end(model_parameters), [&](const auto& p) {
          return p.model == row.contract.model && std::string_view(p.name) == parameter.name;
        });
    if (own || field(_parameters[i]).empty()) continue;
    const auto model = std::find_if(std::begin(models), std::end(models),
                                    [&](const auto& word) { return word.value == row.contract.model; });
    row.fault =
        std::string(parameter.name) + " must be empty: it is no parameter of the model " + model->text;
    return;
  }
}

void RowReader::read_number(Row& row, const char* name, int place, bool required, double& value) const {
  if (!row.fault.empty()) return;
  const std::string_view text = field(place);
  if (text.empty()) {
    if (required) row.fault = std::string(name) + " is empty";
    return;
  }
  switch (csv::parse_number(text, value)) {
    case csv::NumberError::none:
      return;
    case csv::NumberError::no_number:
      row.fault = std::string(name) + " = " + csv::shown(text) + " is not a number";
      return;
    case csv::NumberError::not_finite:
      row.fault = std::string(name) + " = " + csv::shown(text) + " is not finite";
  }
}

}  // namespace drogue::options_app
