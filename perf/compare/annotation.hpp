#pragma once

#include <string>

#include "perf/compare/comparison.hpp"

/// Texts on compared cases for people and for GitHub. None of them contains the word of a verdict, which only
/// the line of a case does. No function throws.
namespace drogue::perf {

/// Percentage of a fraction, for example "3 %".
std::string percent(double fraction);

/// Change of a time in words, with its interval.
std::string describe_change(const SpeedChange& change);

/// Annotation command of GitHub workflows with its line end: an error if the case `failed`, else a warning or
/// a notice; empty for cases without a change.
std::string annotation(const ComparedCase& row, bool failed);

}  // namespace drogue::perf
