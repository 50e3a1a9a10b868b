#include "miniapps/options/output/summary.hpp"

#include <cmath>
#include <cstdio>
#include <string>

#include "common/csv/header.hpp"
#include "common/program/failure.hpp"

namespace drogue::options_app {
namespace {

std::int64_t ok_rows(const RowCounts& counts) {
  return counts.rows - counts.coarse - counts.invalid - counts.failed;
}

/// Text of a number and its noun: `3 rows`.
std::string counted(std::int64_t number, const char* noun) { return std::to_string(number) + noun; }

/// Text `1 of 3 rows`.
std::string fraction(std::int64_t number, std::int64_t all, const char* noun) {
  return counted(number, " of ") + counted(all, noun);
}

// A surface may have invalid parameter sets, which are input rows, and invalid points of valid sets, which
// are output rows. Each invalid set has one output row.

std::int64_t points(const RowCounts& counts) { return counts.rows - counts.invalid_inputs(); }

std::string invalid_part_of_surface(const RowCounts& counts, std::int64_t sets) {
  const std::string of_sets = fraction(counts.invalid_inputs(), sets, " parameter sets"),
                    of_points = fraction(counts.invalid_points, points(counts), " prices");
  return (counts.invalid_points == 0     ? of_sets
          : counts.invalid_inputs() == 0 ? of_points
                                         : of_sets + " and " + of_points) +
         " invalid";
}

}  // namespace

void print_summary(const Command& command, const run::ResultDocument& result, const RowCounts& counts,
                   std::int64_t input_rows) {
  char time[32];
  std::snprintf(time, sizeof time, " in %.3g s: ", result.timing.wall_s);
  std::string text = result.scene + " on " + result.backend + ": ";
  if (command.action == Action::surface)
    text += counted(input_rows, " parameter sets") + time + counted(counts.invalid_inputs(), " invalid; ") +
            counted(points(counts), " prices: ") + counted(ok_rows(counts), " ok, ") +
            counted(counts.coarse, " coarse, ") + counted(counts.invalid_points, " invalid, ");
  else
    text += counted(counts.rows, " rows") + time + counted(ok_rows(counts), " ok, ") +
            counted(counts.coarse, " coarse, ") + counted(counts.invalid, " invalid, ");
  text += counted(counts.failed, " failed\n");
  if (const auto rate = result.metrics.real("figure_of_merit", "options_per_s")) {
    char speed[128];
    std::snprintf(speed, sizeof speed, "  %.3g options per second of %.3g s of pricing", *rate,
                  result.timing.compute_s);
    text += speed;
    if (const auto stated = result.errors.find("stated"); stated != result.errors.end()) {
      std::snprintf(speed, sizeof speed, "; largest stated error %.2g of the strike", stated->second);
      text += speed;
    }
    text += '\n';
  }
  text += "prices in " + command.out.string() + "\n";
  if (!command.boundary.empty()) text += "boundaries in " + command.boundary.string() + "\n";
  std::fputs(text.c_str(), stdout);
}

void require_all_priced(const Command& command, const RowCounts& counts, const BatchReader& reader) {
  const bool surface = command.action == Action::surface;
  const std::string others = ok_rows(counts) + counts.coarse == 0 ? "; none is"
                             : surface                            ? "; all others are"
                                                                  : "; every other row is";
  const std::string priced = others + " priced in '" + command.out.string() + "'";
  const std::string invalid = surface ? invalid_part_of_surface(counts, reader.rows())
                                      : fraction(counts.invalid, reader.rows(), " rows invalid");
  if (counts.failed > 0) {
    std::string sentence = (surface ? fraction(counts.failed, points(counts), " prices failed")
                                    : fraction(counts.failed, counts.rows, " rows failed")) +
                           ", the first in line " + std::to_string(counts.failed_line);
    if (counts.invalid > 0)
      sentence += ", and " + invalid + ", the first in line " + std::to_string(counts.invalid_line);
    throw Failure(ExitCode::numerical_failure, sentence + priced);
  }
  if (counts.invalid > 0)
    throw csv::invalid_at(reader.file(), counts.invalid_line,
                          counts.invalid_message + " (" + invalid + priced + ")");
}

void describe_counts(const RowCounts& counts, run::ResultDocument& result) {
  const auto set = [&result](const char* name, std::int64_t rows) {
    result.metrics.set("counts", name, rows);
  };
  set("coarse", counts.coarse);
  set("failed", counts.failed);
  set("invalid", counts.invalid);
  set("ok", ok_rows(counts));
  set("rows", counts.rows);
  if (std::isfinite(counts.largest_error)) result.errors["stated"] = counts.largest_error;
  const std::int64_t priced = ok_rows(counts) + counts.coarse;
  if (const double seconds = result.timing.compute_s; priced > 0 && seconds > 0.0)
    result.metrics.set("figure_of_merit", "options_per_s", static_cast<double>(priced) / seconds);
}

}  // namespace drogue::options_app
