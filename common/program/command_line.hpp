#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace drogue {

/// Command-line arguments; `--kokkos-*` are passed to Kokkos unchanged.
struct Arguments {
  std::vector<std::string> program;
  std::vector<std::string> kokkos;
};

/// Splits argv[1..], in order. Does not throw.
Arguments split_arguments(int argc, const char* const* argv);

/// Parses `words` into the variables that `app` is bound to. Returns the help text for --help, otherwise an
/// empty text. Throws `Failure` (usage): an unknown option, with the nearest valid one, a missing value, or a
/// surplus argument.
std::string parse_command_line(CLI::App& app, const std::vector<std::string>& words);

/// Declares `--backend` with the names of all backends.
void add_backend_option(CLI::App& app, std::string& backend);

/// Throws `Failure` (usage) for an option with an empty value, say from an unset script variable, which must
/// not count as absent.
void require_nonempty_values(const CLI::App& app);

/// Values of the option --backend: auto and every backend that the sources support, whether or not this build
/// contains it. Does not throw.
std::vector<std::string> backend_choices();

}  // namespace drogue
