#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace drogue {

/// The words of a command line; `--kokkos-*` belong to Kokkos and are handed to it untouched.
struct Arguments {
  std::vector<std::string> program;
  std::vector<std::string> kokkos;
};

/// Splits argv[1..] in the order given.
Arguments split_arguments(int argc, const char* const* argv);

/// Parses `words` into what `app` is bound to. Returns the help text if --help is among them, else nothing.
/// Throws Failure(usage): an unknown option with the nearest valid one, a missing value, a word too many.
std::string parse_command_line(CLI::App& app, const std::vector<std::string>& words);

}  // namespace drogue
