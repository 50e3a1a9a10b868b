#pragma once

#include <optional>
#include <string>

#include "perf/compare/record_file.hpp"

namespace drogue::perf {

/// Reason why times of the two records mean different things, none if they can be compared: another device,
/// number of threads, compiler flags, unit or size; on a GPU other clocks. Does not throw.
std::optional<std::string> why_not_comparable(const MeasuredCase& before, const MeasuredCase& after);

/// Difference of the errors beyond round-off, none if they agree. Errors agree if they differ by at most 1e-6
/// of the larger one. Errors below 1e-9 are of the size of round-off and may also differ by a factor of ten.
/// A check that only one of the records passed is a difference. Does not throw.
std::optional<std::string> error_change(const MeasuredCase& before, const MeasuredCase& after);

}  // namespace drogue::perf
