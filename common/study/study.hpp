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

/// What studies of all programs have in common: tables of errors and times, and how they come about.
namespace drogue::study {

/// One run of a study, or several of the same scene.
struct Row {
  std::string label;                                              ///< of its curve in the picture
  std::vector<std::variant<std::string, std::int64_t>> settings;  ///< as `Columns::settings` names them
  std::int64_t mesh = 0, steps = 0;
  std::vector<double> samples;                        ///< compute time of each run, s
  std::map<std::string, double> errors;               ///< `errors` of study.json
  std::map<std::string, double> others;               ///< beside them in study.json
  std::map<std::string, std::vector<double>> series;  ///< likewise, over time
  ExitCode code = ExitCode::ok;                       ///< a failure, with `message`, has no errors
  std::string message;
};

/// The columns of study.csv, the usual ones apart: `label`, settings, `backend`, mesh, `steps`, `compute_s`,
/// errors, `status`.
struct Columns {
  std::vector<std::string> settings;
  std::string mesh;                 ///< say cells
  std::vector<std::string> errors;  ///< of `Row::errors` or `Row::others`; empty where a row has none
  std::string shown, shown_title;   ///< the error on the line of a run, and what it is called; may be empty
};

/// Does point `i` of a study: appends its row, and may amend rows before it. False once a signal ended it.
using RunPoint = std::function<bool(std::size_t i, std::vector<Row>& rows)>;

/// Runs `count` points, writes study.csv and study.json after every one, so that whatever ends a long study
/// leaves what it has found, and lets drogue-plot draw them. `columns` may grow while points run. Returns
/// `interrupted` or `ok`; throws Failure: numerical_failure if every run failed.
ExitCode run_points(const run::RunDirectory& directory, const run::ResultDocument& facts,
                    const Columns& columns, std::size_t count, const RunPoint& run_point, bool quiet);

}  // namespace drogue::study
