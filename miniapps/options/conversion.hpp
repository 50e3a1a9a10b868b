#pragma once

#include <filesystem>
#include <string>

#include "common/program/program.hpp"

namespace drogue::options_app {

/// Command line of `convert`, checked.
struct ConversionCommand {
  std::string family;           ///< name of a `ParameterFamily`
  std::string input;            ///< CSV file, or empty
  std::string parameters;       ///< `name=value,...`, or empty
  std::filesystem::path out;    ///< empty: standard output
  double periods = 1.0;         ///< per year: the parameters describe the returns of one
  bool unit_is_period = false;  ///< the rows count time in periods; else in years
};

/// Writes the parameters of the input as columns of a batch; other columns of a batch are kept. Throws
/// `Failure`: invalid_scene for a file or a row that cannot be converted, before anything is written; usage
/// for `parameters`; io_error.
ExitCode convert_parameters(const ConversionCommand& command);

}  // namespace drogue::options_app
