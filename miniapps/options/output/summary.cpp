#include "miniapps/options/summary.hpp"

#include <cstdio>
#include <string>

#include "common/csv/header.hpp"
#include "common/program/failure.hpp"

namespace drogue::options_app {
namespace {

std::int64_t priced_well(const Tally& tally) {
  return tally.rows - tally.coarse - tally.invalid - tally.failed;
}

std::string counted(std::int64_t number, const char* what) { return std::to_string(number) + what; }

std::string share(std::int64_t number, std::int64_t all, const char* what) {
  return counted(number, " of ") + counted(all, what);
}

// What is invalid of a surface are parameter sets, rows of the input, or points of valid ones; what is priced
// are points, rows of the output.

std::int64_t invalid_sets(const Tally& tally) { return tally.invalid - tally.invalid_points; }

std::int64_t points(const Tally& tally) { return tally.rows - invalid_sets(tally); }

std::string invalid_of_surface(const Tally& tally, std::int64_t sets) {
  const std::string of_sets = share(invalid_sets(tally), sets, " parameter sets"),
                    of_points = share(tally.invalid_points, points(tally), " prices");
  return (tally.invalid_points == 0  ? of_sets
          : invalid_sets(tally) == 0 ? of_points
                                     : of_sets + " and " + of_points) +
         " invalid";
}

}  // namespace

void print_summary(const Command& command, const run::ResultDocument& result, const Tally& tally,
                   std::int64_t read) {
  char time[32];
  std::snprintf(time, sizeof time, " in %.3g s: ", result.timing.wall_s);
  std::string text = result.scene + " on " + result.backend + ": ";
  if (command.action == Action::surface)
    text += counted(read, " parameter sets") + time + counted(invalid_sets(tally), " invalid; ") +
            counted(points(tally), " prices: ") + counted(priced_well(tally), " ok, ") +
            counted(tally.coarse, " coarse, ") + counted(tally.invalid_points, " invalid, ");
  else
    text += counted(tally.rows, " rows") + time + counted(priced_well(tally), " ok, ") +
            counted(tally.coarse, " coarse, ") + counted(tally.invalid, " invalid, ");
  text += counted(tally.failed, " failed\n") + "prices in " + command.out.string() + "\n";
  if (!command.boundary.empty()) text += "boundaries in " + command.boundary.string() + "\n";
  std::fputs(text.c_str(), stdout);
}

void require_priced_rows(const Command& command, const Tally& tally, const BatchReader& reader) {
  const bool surface = command.action == Action::surface;
  const std::string rest = std::string(surface ? "; all others are" : "; every other row is") +
                           " priced in '" + command.out.string() + "'";
  const std::string invalid = surface ? invalid_of_surface(tally, reader.rows())
                                      : share(tally.invalid, reader.rows(), " rows invalid");
  if (tally.failed > 0) {
    std::string told = (surface ? share(tally.failed, points(tally), " prices failed")
                                : share(tally.failed, tally.rows, " rows failed")) +
                       ", the first in line " + std::to_string(tally.failed_line);
    if (tally.invalid > 0)
      told += ", and " + invalid + ", the first in line " + std::to_string(tally.invalid_line);
    throw Failure(ExitCode::numerical_failure, told + rest);
  }
  if (tally.invalid > 0)
    throw csv::invalid_at(reader.file(), tally.invalid_line,
                          tally.invalid_fault + " (" + invalid + rest + ")");
}

void count_rows(const Tally& tally, run::ResultDocument& result) {
  const auto set = [&result](const char* name, std::int64_t rows) {
    result.metrics.set("counts", name, rows);
  };
  set("coarse", tally.coarse);
  set("failed", tally.failed);
  set("invalid", tally.invalid);
  set("ok", priced_well(tally));
  set("rows", tally.rows);
}

}  // namespace drogue::options_app
