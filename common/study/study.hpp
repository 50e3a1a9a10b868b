#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "common/program/failure.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"

/// Studies: tables of errors and times over meshes and schemes.
namespace drogue::study {

/// Result of one point of a study, from one or several runs.
struct StudyRow {
  std::string label;                                              ///< legend of its curve
  std::vector<std::variant<std::string, std::int64_t>> settings;  ///< as `Columns::settings` names them
  std::int64_t mesh = 0, steps = 0;
  std::vector<double> samples;                        ///< compute time of each run, s
  std::map<std::string, double> errors;               ///< `errors` of study.json
  std::map<std::string, double> others;               ///< beside them in study.json
  std::map<std::string, std::vector<double>> series;  ///< likewise, over time
  ExitCode code = ExitCode::ok;                       ///< after a failure there are no errors
  std::string message;
};

/// Columns of study.csv beside the fixed ones: `label`, settings, `backend`, mesh, `steps`, `compute_s`,
/// errors, `status`.
struct Columns {
  std::vector<std::string> settings;
  std::string mesh;  ///< say cells
  std::vector<std::string>
      errors;  ///< of `StudyRow::errors` or `StudyRow::others`; empty where a row has none
  std::string shown, shown_title;  ///< the error on the line of a run, and what it is called; may be empty
};

/// Runs point `i`: appends its row, and may amend earlier rows. Returns false after a signal.
using RunPoint = std::function<bool(std::size_t i, std::vector<StudyRow>& rows)>;

/// Runs `count` points. Writes study.csv and study.json after every point, so that an interrupted study keeps
/// its results, then starts drogue-plot. `columns` may grow while points run. Returns `interrupted` or `ok`.
/// Throws `Failure` (numerical_failure) if every run failed.
ExitCode run_points(const run::RunDirectory& directory, const run::ResultDocument& facts,
                    const Columns& columns, std::size_t count, const RunPoint& run_point, bool quiet);

}  // namespace drogue::study
