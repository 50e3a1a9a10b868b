#include "miniapps/options/conversion.hpp"

#include <algorithm>
#include <functional>
#include <iostream>
#include <vector>

#include "common/csv/fields.hpp"
#include "common/csv/header.hpp"
#include "common/csv/numbers.hpp"
#include "common/program/failure.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/options/contract_check.hpp"
#include "miniapps/options/input/parameter_families.hpp"

namespace drogue::options_app {
namespace {

/// Column of a batch that an input may hold as well.
struct KeptColumn {
  const char* name;
  int power_of_time;  ///< of the unit of time in its unit; 2: no number
};
constexpr int is_text = 2;
constexpr KeptColumn kept_columns[] = {{"id", is_text},  {"style", is_text}, {"type", is_text},
                                       {"spot", 0},      {"strike", 0},      {"rate", -1},
                                       {"dividend", -1}, {"maturity", 1}};

/// Throws the failure of a row or an option, given a sentence.
using Fail = std::function<Failure(const std::string&)>;

class Converter {
 public:
  explicit Converter(const ConversionCommand& command)
      : _command(command), _family(family_of(command.family)) {}

  [[nodiscard]] std::string from_option() const {
    const Fail fail = [](const std::string& sentence) {
      return Failure(ExitCode::usage, "--parameters: " + sentence);
    };
    const std::vector<std::string> names = parameter_names();
    csv::Fields assignments;
    if (const std::string_view wrong = assignments.split(_command.parameters); !wrong.empty())
      throw fail(std::string(wrong));
    std::vector<double> values;
    for (const FamilyParameter& parameter : _family.parameters) values.push_back(parameter.usual);
    std::vector<bool> is_given(names.size(), false);
    for (std::size_t i = 0; i < assignments.size(); ++i) {
      const std::string_view text = assignments[i], name = text.substr(0, text.find('='));
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
        throw fail("unknown parameter " + csv::shown(name) + "; " +
                   scene::suggestion(std::string(name), names));
      const auto at = static_cast<std::size_t>(found - names.begin());
      if (is_given[at]) throw fail(*found + " is given twice");
      is_given[at] = true;
      values[at] = number(*found, text.substr(std::min(name.size() + 1, text.size())), fail);
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!is_given[i] && _family.parameters[i].required) throw fail(names[i] + " is missing");
    std::string text = "lambda,alpha,beta,delta,variance\n";
    append_jump(text, values, fail);
    return text + '\n';
  }

  [[nodiscard]] std::string from_file() const {
    csv::LineReader reader(_command.input);
    std::vector<std::string> names = parameter_names();
    const std::size_t count = names.size();
    for (const KeptColumn& column : kept_columns) names.emplace_back(column.name);
    const csv::Header header = csv::read_header(reader, names);
    for (std::size_t i = 0; i < count; ++i)
      if (header.places[i] < 0 && _family.parameters[i].required)
        throw csv::invalid_at(reader.file(), header.line, "the column " + names[i] + " is missing");
    const auto columns = static_cast<std::size_t>(
        std::count_if(header.places.begin(), header.places.end(), [](int place) { return place >= 0; }));
    std::string text;
    for (std::size_t i = count; i < names.size(); ++i)
      if (header.places[i] >= 0) text += names[i] + ',';
    text += "lambda,alpha,beta,delta,variance\n";
    csv::Fields fields;
    csv::Line line;
    while (reader.next(line)) {
      const Fail fail = [&](const std::string& sentence) {
        return csv::invalid_at(reader.file(), line.number, sentence);
      };
      if (line.too_long)
        throw fail("the line is longer than " + std::to_string(csv::LineReader::longest) + " bytes");
      if (const std::string_view wrong = fields.split(line.text); !wrong.empty())
        throw fail(std::string(wrong));
      fields.drop_trailing_empty(columns);
      if (fields.size() != columns)
        throw fail("the row has " + std::to_string(fields.size()) + " fields where the header has " +
                   std::to_string(columns));
      const auto field = [&](std::size_t i) {
        return header.places[i] < 0 ? std::string_view() : fields[static_cast<std::size_t>(header.places[i])];
      };
      for (std::size_t i = count; i < names.size(); ++i)
        if (header.places[i] >= 0) append_kept(text, kept_columns[i - count], field(i), fail);
      std::vector<double> values;
      for (std::size_t i = 0; i < count; ++i) {
        const FamilyParameter& parameter = _family.parameters[i];
        values.push_back(field(i).empty() && !parameter.required ? parameter.usual
                                                                 : number(names[i], field(i), fail));
      }
      append_jump(text, values, fail);
      text += '\n';
    }
    return text;
  }

 private:
  static const ParameterFamily& family_of(const std::string& name) {
    const auto& families = parameter_families();
    return *std::find_if(families.begin(), families.end(),
                         [&](const auto& each) { return each.name == name; });
  }

  [[nodiscard]] std::vector<std::string> parameter_names() const {
    std::vector<std::string> names;
    for (const FamilyParameter& parameter : _family.parameters) names.emplace_back(parameter.name);
    return names;
  }

  static double number(const std::string& name, std::string_view text, const Fail& fail) {
    double value = 0.0;
    if (csv::parse_number(text, value) != csv::NumberError::none)
      throw fail(name + " = " + csv::shown(text) + " is not a finite number");
    return value;
  }

  /// Appends a kept field and a comma. In periods, rates are smaller and maturities longer.
  void append_kept(std::string& text, const KeptColumn& column, std::string_view field,
                   const Fail& fail) const {
    if (column.power_of_time == is_text || column.power_of_time == 0 || !_command.unit_is_period ||
        field.empty()) {
      csv::append_field(text, field);
    } else {
      const double value = number(column.name, field, fail);
      csv::append_number(text,
                         column.power_of_time > 0 ? value * _command.periods : value / _command.periods);
    }
    text += ',';
  }

  void append_jump(std::string& text, const std::vector<double>& values, const Fail& fail) const {
    if (const std::string_view clause = _family.violated(values.data()); !clause.empty())
      throw fail(std::string(clause));
    options::Contract contract;
    _family.convert(values.data(), contract.jump);
    const options::Contract of_period = contract;
    if (!_command.unit_is_period && !scale_periods(contract.jump, _command.periods))
      throw fail(
          "sums of such returns are not generalized hyperbolic, except for variance gamma and p = -0.5: "
          "--time-unit period gives rows that count time in periods");
    if (const std::string_view clause = options::violated_condition(contract); !clause.empty())
      throw fail(std::string(clause) + (options::violated_condition(of_period).empty()
                                            ? "; --time-unit period gives rows that count time in periods"
                                            : ""));
    for (const double parameter : contract.jump) {
      csv::append_number(text, parameter);
      text += ',';
    }
    text += '0';
  }

  const ConversionCommand& _command;
  const ParameterFamily& _family;
};

}  // namespace

ExitCode convert_parameters(const ConversionCommand& command) {
  const Converter converter(command);
  const std::string text = command.input.empty() ? converter.from_option() : converter.from_file();
  if (command.out.empty()) {
    std::cout << text;  // the program flushes it, and reports what cannot be written
  } else {
    run::AtomicFile file(command.out);
    file.write(text);
    file.commit();
  }
  return ExitCode::ok;
}

}  // namespace drogue::options_app
