#include "miniapps/options/command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>

#include "common/csv/numbers.hpp"
#include "common/program/command_line.hpp"
#include "common/program/failure.hpp"
#include "miniapps/options/input/parameter_families.hpp"

namespace drogue::options_app {
namespace {

/// Option values of a subcommand, not checked yet.
struct OptionValues {
  std::string input, out, result, boundary, method = "pide", tolerance, mesh, steps, strikes, maturities,
                                            chunk;
  std::string family, parameters, periods, time_unit = "year";
  bool greeks = false;
};

void declare_pricing(CLI::App& app, OptionValues& values, Command& command) {
  add_backend_option(app, command.backend);
  app.add_option("--method", values.method,
                 "pide: finite differences; cos: Fourier; seed: that of [Shi] (README.md), without an error")
      ->check(CLI::IsMember({"pide", "cos", "seed"}))
      ->capture_default_str();
  auto* tolerance = app.add_option("--tolerance", values.tolerance,
                                   "largest error, in strikes; chooses mesh and steps (1e-4)")
                        ->type_name("E");
  auto* mesh = app.add_option("--mesh", values.mesh, "intervals in space, even, 32 .. 4096")
                   ->type_name("N")
                   ->excludes(tolerance);
  auto* steps = app.add_option("--steps", values.steps, "steps in time, even, 8 .. 16384")
                    ->type_name("N")
                    ->excludes(tolerance);
  mesh->needs(steps);
  steps->needs(mesh);
  app.add_flag("--greeks", values.greeks,
               "delta, gamma, theta, vega and rho too (American: four more solves)");
  app.add_option("--result", values.result, "write timing and counts as JSON")->type_name("FILE");
  app.add_option("--chunk", values.chunk, "rows priced at a time; changes no result (default: by speed)")
      ->type_name("N");
  app.add_flag("--quiet", command.quiet, "show no progress and no summary");
}

void declare_conversion(CLI::App& app, OptionValues& values) {
  std::vector<std::string> families;
  for (const ParameterFamily& family : parameter_families()) families.emplace_back(family.name);
  app.add_option("FAMILY", values.family, "what the parameters describe")
      ->required()
      ->check(CLI::IsMember(families));
  auto* file =
      app.add_option("PARAMS", values.input, "CSV file of parameters, and columns of a batch to keep");
  app.add_option("--parameters", values.parameters,
                 "one set instead of a file, say sigma=0.12,nu=0.17,theta=-0.14")
      ->type_name("LIST")
      ->excludes(file);
  app.add_option("--periods-per-year", values.periods,
                 "the parameters describe the returns of one period, say 252 for days (1)")
      ->type_name("N");
  app.add_option("--time-unit", values.time_unit, "unit of time of the rows that are written")
      ->check(CLI::IsMember({"year", "period"}))
      ->capture_default_str();
  app.add_option("--out", values.out, "CSV file (standard output)")->type_name("FILE");
}

/// Divisibility of a number and its name in error messages.
struct NumberKind {
  const char* name;
  int multiple;  ///< the number is a multiple of it; 0: no restriction
};
constexpr NumberKind any_number{"a number", 0}, whole_number{"a whole number", 1},
    even_number{"an even whole number", 2};

double parse_number(const std::string& option, const std::string& text, double min, double max,
                    const NumberKind& kind = any_number) {
  double value = 0.0;
  const bool valid = csv::parse_number(text, value) == csv::NumberError::none;
  if (valid && value >= min && value <= max && (kind.multiple == 0 || std::fmod(value, kind.multiple) == 0.0))
    return value;
  std::string sentence = option + " = '" + text + "' is not " + kind.name + " in ";
  csv::append_number(sentence, min);
  sentence += " .. ";
  csv::append_number(sentence, max);
  throw Failure(ExitCode::usage, sentence);
}

int parse_integer(const std::string& option, const std::string& text, int min, int max,
                  const NumberKind& kind = whole_number) {
  return static_cast<int>(parse_number(option, text, min, max, kind));
}

options::Settings pricer_settings(const OptionValues& values) {
  options::Settings settings;
  settings.method = values.method == "cos"    ? options::Method::cos
                    : values.method == "seed" ? options::Method::baseline
                                              : options::Method::pide;
  if (!values.tolerance.empty())
    settings.tolerance = parse_number("--tolerance", values.tolerance, 1e-12, 1.0);
  // The ranges of options::create_pricer.
  if (!values.mesh.empty()) settings.mesh = parse_integer("--mesh", values.mesh, 32, 4096, even_number);
  if (!values.steps.empty()) settings.steps = parse_integer("--steps", values.steps, 8, 16384, even_number);
  settings.greeks = values.greeks;
  settings.time_copies = true;  // for h2d_s and d2h_s of result.json
  if (settings.method == options::Method::cos && settings.mesh > 0)
    throw Failure(ExitCode::usage, "--method cos has no mesh: give it a --tolerance");
  if (settings.method == options::Method::baseline && settings.mesh == 0)
    throw Failure(ExitCode::usage, "--method seed chooses nothing by itself: give it --mesh and --steps");
  return settings;
}

}  // namespace

namespace {

ConversionCommand conversion_of(const OptionValues& values) {
  if (values.input.empty() && values.parameters.empty())
    throw Failure(ExitCode::usage, "convert needs a CSV file or --parameters");
  ConversionCommand conversion;
  conversion.family = values.family;
  conversion.input = values.input;
  conversion.parameters = values.parameters;
  conversion.out = values.out;
  if (!values.periods.empty())
    conversion.periods = parse_number("--periods-per-year", values.periods, 1e-3, 1e9);
  conversion.unit_is_period = values.time_unit == "period";
  return conversion;
}

/// Parts of `text` between separators, without the blanks around each.
std::vector<std::string> trimmed_parts(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::size_t first = std::min(part.find_first_not_of(" \t"), part.size());
    parts.push_back(part.substr(first, part.find_last_not_of(" \t") + 1 - first));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

std::vector<double> parse_values(const std::string& option, const std::string& text) {
  constexpr double min = 1e-300, max = 1e300;
  constexpr int max_values = 10000;
  const char separator = text.find(':') == std::string::npos ? ',' : ':';
  std::vector<std::string> parts = trimmed_parts(text, separator);
  std::vector<double> values;
  if (separator == ',') {
    if (parts.size() > 1 && parts.back().empty()) parts.pop_back();  // a comma at the end
    if (parts.size() > max_values)
      throw Failure(ExitCode::usage, option + " has more than " + std::to_string(max_values) + " values");
    for (const std::string& part : parts) values.push_back(parse_number(option, part, min, max));
    return values;
  }
  if (parts.size() != 3)
    throw Failure(ExitCode::usage,
                  option + " needs first:last:count or a list with commas, not '" + text + "'");
  const double first = parse_number(option, parts[0], min, max);
  const double last = parse_number(option, parts[1], min, max);
  const int count = parse_integer(option, parts[2], 1, max_values);
  if (count == 1 && first != last)
    throw Failure(ExitCode::usage, option + " = '" + text +
                                       "' has two ends but a count of 1: give a count of 2 " +
                                       "or more, or one value");
  for (int i = 0; i < count; ++i)
    values.push_back(i + 1 == count && count > 1 ? last
                                                 : first + (last - first) * i / std::max(count - 1, 1));
  return values;
}

Command parse_command(int argc, const char* const* argv) {
  Command command;
  OptionValues values;
  bool version = false, list = false;
  CLI::App app("Prices American and European options under jumps, each with its error.", "drogue-options");
  app.add_flag("--version", version, "print version, backends and libraries, and end");
  app.add_flag("--list-batches", list, "list the shipped batches, and end");
  app.footer("--kokkos-* options are passed to Kokkos.");
  CLI::App* price = app.add_subcommand("price", "price every contract of a CSV file");
  price->add_option("BATCH", values.input, "CSV file, or name of a shipped batch")->required();
  price->add_option("--out", values.out, "CSV file of the prices (prices.csv)")->type_name("FILE");
  price
      ->add_option("--boundary", values.boundary,
                   "write the exercise boundaries of American contracts (pide)")
      ->type_name("FILE");
  declare_pricing(*price, values, command);
  CLI::App* surface = app.add_subcommand("surface", "price strikes x maturities for every parameter set");
  surface->add_option("PARAMS", values.input, "CSV file without strike and maturity")->required();
  surface->add_option("--strikes", values.strikes, "first:last:count, or a list, in money")->required();
  surface->add_option("--maturities", values.maturities, "first:last:count, or a list, in years")->required();
  surface->add_option("--out", values.out, "CSV file of the prices (surface.csv)")->type_name("FILE");
  declare_pricing(*surface, values, command);
  CLI::App* convert = app.add_subcommand("convert", "write other parameters of jumps as columns of a batch");
  declare_conversion(*convert, values);

  Arguments arguments = split_arguments(argc, argv);
  command.help = parse_command_line(app, arguments.program);
  command.kokkos = std::move(arguments.kokkos);
  if (!command.help.empty()) return command;
  if (version || list) {
    command.action = version ? Action::version : Action::list_batches;
    return command;
  }
  if (convert->parsed()) {
    require_nonempty_values(*convert);
    command.action = Action::convert;
    command.conversion = conversion_of(values);
    return command;
  }
  const bool prices = price->parsed();
  if (!prices && !surface->parsed())
    throw Failure(ExitCode::usage,
                  "no command given: price, surface or convert; --help shows what they take");
  require_nonempty_values(prices ? *price : *surface);
  command.action = prices ? Action::price : Action::surface;
  command.input = values.input;
  command.out = !values.out.empty() ? values.out : prices ? "prices.csv" : "surface.csv";
  command.result = values.result;
  command.boundary = values.boundary;
  command.settings = pricer_settings(values);
  if (!values.boundary.empty() && command.settings.method != options::Method::pide)
    throw Failure(ExitCode::usage, "--boundary needs --method pide: the others give no curve");
  if (!values.chunk.empty())
    command.chunk = static_cast<std::size_t>(parse_integer("--chunk", values.chunk, 1, 1 << 20));
  if (!prices) {
    command.strikes = parse_values("--strikes", values.strikes);
    command.maturities = parse_values("--maturities", values.maturities);
    command.settings.surface = command.settings.method == options::Method::pide;
  }
  return command;
}

}  // namespace drogue::options_app
