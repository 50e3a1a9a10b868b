#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "perf/compare/comparison.hpp"

/// Texts on compared cases for people and for GitHub. None of them contains the word of a verdict, which only
/// the line of a case does. No function throws.
namespace drogue::perf {

/// Percentage of a fraction, for example "3 %".
std::string percent(double fraction);

/// Change of a time in words, with its interval.
std::string describe_change(const SpeedChange& change);

/// Change of a case in words, or that its samples are too few for one, or the reason of a verdict without
/// times.
std::string describe(const ComparedCase& row);

/// Number of cases by verdict and the mean change of their times, in a line.
std::string summary(const std::vector<ComparedCase>& rows);

/// Verdicts as a document: `old` and `new`, what was compared, `summary`, and `cases`, each with `case`,
/// `verdict`, `reason`, `ratio`, `low`, `high`, `old_s`, `new_s` and `unit`; numbers that there are not are
/// null.
nlohmann::json verdicts_json(const std::string& before, const std::string& after,
                             const std::vector<ComparedCase>& rows);

/// Annotation command of GitHub workflows with its line end: an error if the case `failed`, else a warning or
/// a notice; empty for other cases without a change.
std::string annotation(const ComparedCase& row, bool failed);

}  // namespace drogue::perf
