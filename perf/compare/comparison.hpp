#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/compare/record_file.hpp"
#include "perf/compare/speed.hpp"

namespace drogue::perf {

/// Word for a verdict, as `compare` prints it: SAME, FASTER and so on. Does not throw.
const char* word(Verdict verdict);

/// Files that hold a case.
enum class Presence { both, old_alone, new_alone };

/// Case of two files of records.
struct ComparedCase {
  std::string name;
  Verdict verdict = Verdict::not_comparable;
  std::string reason;                     ///< of `not_comparable` and `error_changed`
  std::optional<SpeedChange> speed = {};  ///< of the others
  double old_time = 0.0;                  ///< median of all samples, beside `speed`
  double new_time = 0.0;
  std::string unit = {};  ///< of the times
  Presence presence = Presence::both;
  bool untimed = false;  ///< the old records have no samples either: values that are computed
};

/// True if the new records leave a case of the old ones unknown: it vanished, or its times have another
/// meaning, or there are none. Does not throw.
bool is_lost(const ComparedCase& row);

/// Verdicts of all cases: those of `after` in its order, then those of `before` alone. Several records of a
/// case in a file are runs of one build, whose differences are noise. Throws Failure(invalid_scene) if such
/// records cannot be compared with each other.
std::vector<ComparedCase> compare_records(const std::vector<MeasuredCase>& before,
                                          const std::vector<MeasuredCase>& after);

/// Reason why times of the two records mean different things, none if they can be compared: another device,
/// number of threads, compiler flags, unit or size; on a GPU other clocks. Does not throw.
std::optional<std::string> why_not_comparable(const MeasuredCase& before, const MeasuredCase& after);

/// Difference of the errors beyond round-off, none if they agree. Errors agree if they differ by at most 1e-6
/// of the larger one. Errors below 1e-9 are of the size of round-off and may also differ by a factor of ten.
/// A check that only one of the records passed is a difference. Does not throw.
std::optional<std::string> error_change(const MeasuredCase& before, const MeasuredCase& after);

}  // namespace drogue::perf
