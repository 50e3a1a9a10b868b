#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/options/pricer.hpp"

namespace drogue::options_app {

enum class Action { help, version, list_batches, price, surface };

/// What the command line asks for, checked.
struct Command {
  Action action = Action::help;
  std::string help;
  std::string input;                            ///< a CSV file, or the name of a shipped batch
  std::filesystem::path out, result, boundary;  ///< an empty path: not asked for
  std::string backend = "auto";
  options::Settings settings;
  std::vector<double> strikes, maturities;  ///< of a surface
  std::size_t chunk = 0;                    ///< rows priced at a time; 0: as many as take a tenth of a second
  bool quiet = false;
  std::vector<std::string> kokkos;  ///< `--kokkos-*`, untouched
};

/// Throws Failure(usage): an unknown option with the nearest one, a value out of range, options that exclude
/// each other.
Command parse_command(int argc, const char* const* argv);

/// Numbers as `a:b:n`, n of them from a to b, or as a list with commas. Throws Failure(usage): none, one that
/// is not positive and finite, more than 10000.
std::vector<double> parse_values(const std::string& option, const std::string& text);

}  // namespace drogue::options_app
