#include "miniapps/options/command.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>

#include "common/csv/numbers.hpp"
#include "common/program/command_line.hpp"
#include "common/program/failure.hpp"

namespace drogue::options_app {
namespace {

/// What the words of a subcommand are bound to before they are checked.
struct Words {
  std::string input, out, result, boundary, method = "pide", tolerance, mesh, steps, strikes, maturities,
                                            chunk;
  bool greeks = false;
};

void declare_pricing(CLI::App& app, Words& words, Command& command) {
  app.add_option("--backend", command.backend, "where to compute: auto takes the fastest present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app.add_option("--method", words.method,
                 "pide: finite differences; cos: Fourier; seed: the dissertation's, which states no error")
      ->check(CLI::IsMember({"pide", "cos", "seed"}))
      ->capture_default_str();
  auto* tolerance = app.add_option("--tolerance", words.tolerance,
                                   "largest error, in strikes; chooses mesh and steps (1e-4)")
                        ->type_name("E");
  auto* mesh = app.add_option("--mesh", words.mesh, "intervals in space, even, 32 .. 4096")
                   ->type_name("N")
                   ->excludes(tolerance);
  auto* steps = app.add_option("--steps", words.steps, "steps in time, even, 8 .. 16384")
                    ->type_name("N")
                    ->excludes(tolerance);
  mesh->needs(steps);
  steps->needs(mesh);
  app.add_flag("--greeks", words.greeks, "delta, gamma and theta too");
  app.add_option("--result", words.result, "write timing and counts as JSON")->type_name("FILE");
  app.add_option("--chunk", words.chunk, "rows priced at a time; changes no result (default: by speed)")
      ->type_name("N");
  app.add_flag("--quiet", command.quiet, "show no progress and no summary");
}

/// An option given as "", say by a variable of a script that is not set: it must not pass for one not given.
void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) throw Failure(ExitCode::usage, option->get_name() + " is empty");
}

/// What a number may be a multiple of, as a sentence says it.
struct Kind {
  const char* what;
  int multiple;  ///< 0: of nothing
};
constexpr Kind any{"a number", 0}, whole{"a whole number", 1}, even{"an even whole number", 2};

double number(const std::string& option, const std::string& text, double least, double most,
              const Kind& kind = any) {
  double value = 0.0;
  const bool valid = csv::parse_number(text, value) == csv::NumberError::none;
  if (valid && value >= least && value <= most &&
      (kind.multiple == 0 || std::fmod(value, kind.multiple) == 0.0))
    return value;
  std::string sentence = option + " = '" + text + "' is not " + kind.what + " in ";
  csv::append_number(sentence, least);
  sentence += " .. ";
  csv::append_number(sentence, most);
  throw Failure(ExitCode::usage, sentence);
}

int whole_number(const std::string& option, const std::string& text, int least, int most,
                 const Kind& kind = whole) {
  return static_cast<int>(number(option, text, least, most, kind));
}

options::Settings settings(const Words& words) {
  options::Settings settings;
  settings.method = words.method == "cos"    ? options::Method::cos
                    : words.method == "seed" ? options::Method::seed
                                             : options::Method::pide;
  if (!words.tolerance.empty()) settings.tolerance = number("--tolerance", words.tolerance, 1e-12, 1.0);
  // What options::create_pricer takes.
  if (!words.mesh.empty()) settings.mesh = whole_number("--mesh", words.mesh, 32, 4096, even);
  if (!words.steps.empty()) settings.steps = whole_number("--steps", words.steps, 8, 16384, even);
  settings.greeks = words.greeks;
  settings.timed_apart = true;  // result.json tells copies apart
  if (settings.method == options::Method::cos && settings.mesh > 0)
    throw Failure(ExitCode::usage, "--method cos has no mesh: give it a --tolerance");
  if (settings.method == options::Method::seed && settings.mesh == 0)
    throw Failure(ExitCode::usage, "--method seed chooses nothing by itself: give it --mesh and --steps");
  return settings;
}

}  // namespace

std::vector<double> parse_values(const std::string& option, const std::string& text) {
  constexpr double least = 1e-300, most = 1e300;
  constexpr int most_values = 10000;
  const char separator = text.find(':') == std::string::npos ? ',' : ':';
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  std::vector<double> values;
  if (separator == ',') {
    if (parts.size() > most_values)
      throw Failure(ExitCode::usage, option + " has more than " + std::to_string(most_values) + " values");
    for (const std::string& part : parts) values.push_back(number(option, part, least, most));
    return values;
  }
  if (parts.size() != 3)
    throw Failure(ExitCode::usage,
                  option + " needs first:last:count or a list with commas, not '" + text + "'");
  const double first = number(option, parts[0], least, most);
  const double last = number(option, parts[1], least, most);
  const int count = whole_number(option, parts[2], 1, most_values);
  for (int i = 0; i < count; ++i)
    values.push_back(i + 1 == count && count > 1 ? last
                                                 : first + (last - first) * i / std::max(count - 1, 1));
  return values;
}

Command parse_command(int argc, const char* const* argv) {
  Command command;
  Words words;
  bool version = false, list = false;
  CLI::App app("Prices American and European options under jumps, each with its error.", "drogue-options");
  app.add_flag("--version", version, "print version, backends and libraries, and end");
  app.add_flag("--list-batches", list, "list the shipped batches, and end");
  app.footer("--kokkos-* options are passed to Kokkos.");
  CLI::App* price = app.add_subcommand("price", "price every contract of a CSV file");
  price->add_option("BATCH", words.input, "CSV file, or name of a shipped batch")->required();
  price->add_option("--out", words.out, "CSV file of the prices (prices.csv)")->type_name("FILE");
  price
      ->add_option("--boundary", words.boundary, "write the exercise boundaries of American contracts (pide)")
      ->type_name("FILE");
  declare_pricing(*price, words, command);
  CLI::App* surface = app.add_subcommand("surface", "price strikes x maturities for every parameter set");
  surface->add_option("PARAMS", words.input, "CSV file without strike and maturity")->required();
  surface->add_option("--strikes", words.strikes, "first:last:count, or a list, in money")->required();
  surface->add_option("--maturities", words.maturities, "first:last:count, or a list, in years")->required();
  surface->add_option("--out", words.out, "CSV file of the prices (surface.csv)")->type_name("FILE");
  declare_pricing(*surface, words, command);

  Arguments arguments = split_arguments(argc, argv);
  command.help = parse_command_line(app, arguments.program);
  command.kokkos = std::move(arguments.kokkos);
  if (!command.help.empty()) return command;
  if (version || list) {
    command.action = version ? Action::version : Action::list_batches;
    return command;
  }
  const bool prices = price->parsed();
  if (!prices && !surface->parsed())
    throw Failure(ExitCode::usage, "no command given: price or surface; --help shows what they take");
  refuse_empty_values(prices ? *price : *surface);
  command.action = prices ? Action::price : Action::surface;
  command.input = words.input;
  command.out = !words.out.empty() ? words.out : prices ? "prices.csv" : "surface.csv";
  command.result = words.result;
  command.boundary = words.boundary;
  command.settings = settings(words);
  if (!words.boundary.empty() && command.settings.method != options::Method::pide)
    throw Failure(ExitCode::usage, "--boundary needs --method pide: the others give no curve");
  if (!words.chunk.empty())
    command.chunk = static_cast<std::size_t>(whole_number("--chunk", words.chunk, 1, 1 << 20));
  if (!prices) {
    command.strikes = parse_values("--strikes", words.strikes);
    command.maturities = parse_values("--maturities", words.maturities);
    command.settings.surface = command.settings.method == options::Method::pide;
  }
  return command;
}

}  // namespace drogue::options_app
