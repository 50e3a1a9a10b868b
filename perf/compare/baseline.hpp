#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "perf/compare/record_file.hpp"

namespace drogue::perf {

/// Records before a change, and what else a folder of baselines holds.
struct Baseline {
  std::string file;
  std::vector<std::string> broken;  ///< sentences on files of the folder that hold no records
};

/// Records for a comparison: `path` itself, or, if it is a folder, its only file *.jsonl whose first record
/// has the processor, GPU and number of threads of `after`. Files of a folder that cannot be read as records
/// are left out and named. Throws Failure: usage if a folder has no such file or several.
Baseline find_baseline(const std::string& path, const MeasuredCase& after);

/// File of a folder for the baseline of a machine, and the records that stay in it.
struct BaselineFile {
  std::string file;
  std::vector<nlohmann::json> kept;  ///< in the order of the file
};

/// File of a folder for new records of `measured`, names of cases, on the machine of `provenance`: that of
/// its present baseline, else a new one, named by processor or GPU and threads. `keep_others`: records of
/// other cases stay in it. Prints what is replaced and what stays. Throws Failure: usage if there is no such
/// folder, and if it has several baselines of the machine.
BaselineFile file_for_baseline(const std::string& folder, const nlohmann::json& provenance,
                               const std::vector<std::string>& measured, bool keep_others);

/// Commit and date of records in words: of the oldest and the latest one, where they differ. `records` is not
/// empty. Does not throw.
std::string describe_origin(const std::vector<MeasuredCase>& records);

/// True if all records are of one commit, which is known and without changes. Does not throw.
bool is_of_one_commit(const std::vector<MeasuredCase>& before, const std::vector<MeasuredCase>& after);

/// Words on how much later `after` was measured than the oldest record of `before`, which is not empty,
/// opening with a semicolon; empty if a date is unknown. Advises to measure the old commit again after
/// `largest_age` days. Does not throw.
std::string describe_age(const std::vector<MeasuredCase>& before, const MeasuredCase& after);
inline constexpr double largest_age = 30.0;

}  // namespace drogue::perf
