#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/options/pricer.hpp"
#include "miniapps/options/conversion.hpp"

namespace drogue::options_app {

enum class Action { help, version, list_batches, price, surface, convert };

/// Command line, checked, with the defaults of absent options.
struct Command {
  Action action = Action::help;
  std::string help;                             ///< text of --help, else empty
  std::string input;                            ///< a CSV file, or the name of a shipped batch
  std::filesystem::path out, result, boundary;  ///< output files; empty: not requested
  std::string backend = "auto";                 ///< auto | serial | openmp | cuda
  options::Settings settings;
  std::vector<double> strikes;     ///< of a surface, money
  std::vector<double> maturities;  ///< of a surface, years
  std::size_t chunk = 0;           ///< rows per chunk; 0: chosen by the measured speed
  ConversionCommand conversion;    ///< of `convert`
  bool quiet = false;
  std::vector<std::string> kokkos;  ///< `--kokkos-*`, untouched
};

/// Parses the command line. Throws `Failure` (usage): unknown option, with the nearest name, a value out of
/// range, mutually exclusive options.
Command parse_command(int argc, const char* const* argv);

/// Parses the value of `option`: `first:last:count` for equally spaced numbers, or a list with commas; blanks
/// around numbers are ignored. Throws `Failure` (usage) for no number, more than 10000, or one that is not
/// positive and finite.
std::vector<double> parse_values(const std::string& option, const std::string& text);

}  // namespace drogue::options_app
