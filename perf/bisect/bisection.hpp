#pragma once

#include <filesystem>
#include <string>

namespace drogue::perf {

/// Search for the commit that changed a case.
struct BisectOptions {
  std::string name, good, bad;  ///< of the case and of two commits, the second a descendant of the first
  std::filesystem::path repository = ".";
  /// Shell command that builds drogue-perf in a working tree, and the program that it makes.
  std::string build = "scripts/build.sh host --target drogue-perf";
  std::string program = "build/host/bin/drogue-perf";
};

/// Prints a line per tested commit and, last, the first bad one. Both programs of a test take turns, and a
/// test that stays in doubt is repeated; if four turns do not suffice, the commit is skipped, as one that
/// does not build or run. Blocking. Throws Failure: usage for unknown commits and cases, verification_failed
/// if the two commits do not differ or skipped commits hide the first bad one, io_error if a build of the two
/// or git fails, interrupted after a signal.
void bisect(const BisectOptions& options);

}  // namespace drogue::perf
