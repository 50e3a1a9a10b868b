#include "miniapps/options/batch_reader.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "common/csv/header.hpp"
#include "common/csv/numbers.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/options/condition.hpp"
#include "miniapps/options/columns.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t longest_id = 256;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// A field as a sentence shows it: short, and on one line.
std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, 40));
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  return '"' + shown + (text.size() > 40 ? "..." : "") + '"';
}

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
  row.fault = std::string(column) + " = " + quoted(text) + ": " + scene::suggestion(text, valid);
}

bool belongs_to(const NumberColumn& column, RowKind kind) {
  return kind == RowKind::contract ||
         (column.member != &options::Contract::strike && column.member != &options::Contract::maturity);
}

}  // namespace

BatchReader::BatchReader(const std::filesystem::path& file, RowKind kind) : _lines(file), _kind(kind) {
  std::vector<std::string> names = input_columns();
  if (kind == RowKind::parameter_set)
    for (const NumberColumn& column : number_columns)
      if (!belongs_to(column, kind)) names.erase(std::find(names.begin(), names.end(), column.name));
  const auto [header_line, places] = csv::read_header(_lines, names);
  const auto place = [&names, &places = places](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : places[static_cast<std::size_t>(found - names.begin())];
  };
  _columns =
      static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [](int p) { return p >= 0; }));
  _places = {place("id"), place("model"), place("style"), place("type"), {}, {}};
  for (const NumberColumn& column : number_columns) _places.numbers.push_back(place(column.name));
  for (const ModelParameter& parameter : model_parameters)
    _places.parameters.push_back(place(parameter.name));
  require_columns(header_line);
}

void BatchReader::require_columns(std::int64_t header_line) const {
  const auto require = [&](const char* name, int place) {
    if (place < 0) throw csv::invalid_at(file(), header_line, "missing column \"" + std::string(name) + '"');
  };
  for (std::size_t i = 0; i < std::size(number_columns); ++i)
    if (number_columns[i].required && belongs_to(number_columns[i], _kind))
      require(number_columns[i].name, _places.numbers[i]);
  if (_places.model >= 0) return;  // each row needs those of its model
  for (std::size_t i = 0; i < std::size(model_parameters); ++i)
    if (model_parameters[i].model == options::Model::generalized_hyperbolic)
      require(model_parameters[i].name, _places.parameters[i]);
}

std::string_view BatchReader::field(int place) const {
  return place < 0 ? std::string_view() : _fields[static_cast<std::size_t>(place)];
}

/// Splits a line of as many fields as there are columns; else `_fault` says what is wrong.
std::string_view BatchReader::split(const csv::Line& line) {
  _fault.clear();
  if (line.too_long) {
    _fault = "the line is longer than " + std::to_string(csv::LineReader::longest) + " bytes";
  } else if (const std::string_view wrong = _fields.split(line.text); !wrong.empty()) {
    _fault = wrong;
  } else if (_fields.size() != _columns) {
    _fault = "the row has " + std::to_string(_fields.size()) + " fields where the header has " +
             std::to_string(_columns);
  }
  return _fault;
}

/// The id of the row after the one before: what stands there, or the row's number where there is none that
/// could be one. `_fault` says what is wrong with the line or its id.
std::string_view BatchReader::next_id() {
  ++_rows;
  const bool whole = split(_line).empty();
  const std::string_view given = whole ? field(_places.id) : std::string_view();
  if (given.size() > longest_id) {
    _fault = "the id is longer than " + std::to_string(longest_id) + " bytes";
  } else if (std::any_of(given.begin(), given.end(), is_control)) {
    _fault = "the id holds a control character";
  } else if (!given.empty()) {
    return given;
  }
  _id = std::to_string(_rows);
  return _id;
}

bool BatchReader::next(std::vector<Row>& rows, std::size_t most) {
  std::size_t count = 0;
  for (; count < most && _lines.next(_line); ++count) {
    if (count == rows.size()) rows.emplace_back();
    Row& row = rows[count];
    row.id = next_id();
    row.line = _line.number;
    row.contract = {};
    row.fault = _fault;
    if (row.fault.empty()) read_contract(row);
  }
  rows.resize(count);
  return count > 0;
}

void BatchReader::read_contract(Row& row) const {
  read_words(row);
  for (std::size_t i = 0; i < std::size(number_columns); ++i)
    read_number(row, number_columns[i].name, _places.numbers[i],
                number_columns[i].required && belongs_to(number_columns[i], _kind),
                row.contract.*number_columns[i].member);
  read_parameters(row);
  if (row.fault.empty()) row.fault = options::violated_condition(row.contract);
}

void BatchReader::read_words(Row& row) const {
  read_word(row, "model", field(_places.model), models, row.contract.model);
  read_word(row, "style", field(_places.style), styles, row.contract.style);
  read_word(row, "type", field(_places.type), types, row.contract.type);
}

/// A parameter of another model than the row's is an error: its value would be passed over in silence.
void BatchReader::read_parameters(Row& row) const {
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    if (parameter.model == row.contract.model)
      read_number(row, parameter.name, _places.parameters[i], true, row.contract.jump[parameter.place]);
  }
  if (!row.fault.empty() || _places.model < 0) return;
  for (std::size_t i = 0; i < std::size(model_parameters); ++i) {
    const ModelParameter& parameter = model_parameters[i];
    const bool own =
        std::any_of(std::begin(model_parameters), std::end(model_parameters), [&](const auto& p) {
          return p.model == row.contract.model && std::string_view(p.name) == parameter.name;
        });
    if (own || field(_places.parameters[i]).empty()) continue;
    const auto model = std::find_if(std::begin(models), std::end(models),
                                    [&](const auto& word) { return word.value == row.contract.model; });
    row.fault =
        std::string(parameter.name) + " must be empty: it is no parameter of the model " + model->text;
    return;
  }
}

void BatchReader::read_number(Row& row, const char* name, int place, bool required, double& value) const {
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
      row.fault = std::string(name) + " = " + quoted(text) + " is not a number";
      return;
    case csv::NumberError::not_finite:
      row.fault = std::string(name) + " = " + quoted(text) + " is not finite";
  }
}

void BatchReader::require_unique_ids() {
  // Eight bytes a row, so that ten million fit: of ids with the same hash, which is nearly always the same
  // id, a second reading says whether they are.
  const std::hash<std::string_view> hash;
  std::vector<std::size_t> hashes;
  while (_lines.next(_line)) hashes.push_back(hash(next_id()));
  std::sort(hashes.begin(), hashes.end());
  std::vector<std::size_t> repeated;
  for (std::size_t i = 1; i < hashes.size(); ++i)
    if (hashes[i] == hashes[i - 1]) repeated.push_back(hashes[i]);
  if (repeated.empty()) return;
  hashes = {};
  std::map<std::string, std::int64_t, std::less<>> first;
  BatchReader again(file(), _kind);
  while (again._lines.next(again._line)) {
    const std::string_view id = again.next_id();
    if (!std::binary_search(repeated.begin(), repeated.end(), hash(id))) continue;
    const auto [place, is_new] = first.emplace(id, again._line.number);
    if (!is_new)
      throw csv::invalid_at(file(), again._line.number,
                            "the id " + quoted(id) + " is that of line " + std::to_string(place->second) +
                                "; every row needs its own");
  }
}

}  // namespace drogue::options_app
