#include "common/program/command_line.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <sstream>
#include <string_view>

#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"
#include "common/version.hpp"

namespace drogue {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands({})) names.push_back(subcommand->get_name());
  return names;
}

Failure unwanted_word(const CLI::App& app, const std::string& word) {
  if (word.rfind('-', 0) != 0) {
    const std::vector<std::string> commands = subcommand_names(app);
    if (commands.empty() || !app.get_subcommands().empty())
      return {ExitCode::usage, "unexpected argument '" + word + "'"};
    return {ExitCode::usage, "unknown command '" + word + "'; " + scene::suggestion(word, commands)};
  }
  const std::string name = word.substr(0, word.find('='));
  return {ExitCode::usage, "unknown option '" + name + "'; " + scene::suggestion(name, option_names(app))};
}

/// The value of an unknown option remains too: report the option.
void refuse_extras(const CLI::App& app) {
  std::vector<std::string> extras = app.remaining();
  // The mark before words that are no options, which CLI11 keeps.
  std::erase(extras, "--");
  if (extras.empty()) return;
  const auto option = std::find_if(extras.begin(), extras.end(),
                                   [](const std::string& word) { return word.starts_with("-"); });
  throw unwanted_word(app, option == extras.end() ? extras.front() : *option);
}

/// Refuses an option that takes one value and has several.
void refuse_repeated(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::size_t times = option->results().size();
    if (option->get_items_expected_max() == 1 && times > 1)
      throw Failure(ExitCode::usage,
                    option->get_name() + " is given " + std::to_string(times) + " times; give it once");
  }
}

}  // namespace

Arguments split_arguments(int argc, const char* const* argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    (word.starts_with("--kokkos-") ? arguments.kokkos : arguments.program).emplace_back(word);
  }
  return arguments;
}

std::string parse_command_line(CLI::App& app, const std::vector<std::string>& words) {
  app.allow_extras();
  for (CLI::App* subcommand : app.get_subcommands({})) subcommand->allow_extras();
  try {
    // CLI11 expects its arguments in reverse order.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    return app.help();
  } catch (const CLI::ArgumentMismatch& error) {
    refuse_repeated(app);
    for (const CLI::App* subcommand : app.get_subcommands()) refuse_repeated(*subcommand);
    throw Failure(ExitCode::usage, error.what());
  } catch (const CLI::ParseError& error) {
    throw Failure(ExitCode::usage, error.what());
  }
  for (const CLI::App* subcommand : app.get_subcommands()) refuse_extras(*subcommand);
  refuse_extras(app);
  return {};
}

std::vector<std::string> backend_choices() {
  std::vector<std::string> choices = {"auto"};
  std::istringstream names{std::string(build_info().known_backends)};
  for (std::string name; names >> name;) choices.push_back(name);
  return choices;
}

void add_backend_option(CLI::App& app, std::string& backend) {
  app.add_option("--backend", backend,
                 "where to compute: auto takes the fastest present, serial for a small mesh")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
}

void require_nonempty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) throw Failure(ExitCode::usage, option->get_name() + " is empty");
    }
  }
}

}  // namespace drogue
