#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/run/history_reader.hpp"
#include "common/run/history_statistics.hpp"
#include "common/run/history_writer.hpp"
#include "common/run/result_document.hpp"
#include "common/scene/table.hpp"
#include "miniapps/framework/scene_keys.hpp"

namespace drogue::framework {

/// Element of [[verify.history]]: a statistic of a column of history.csv, and its expected value.
struct HistoryCheck {
  std::string column;
  run::Statistic statistic = run::Statistic::mean;
  double from = 0.0;              ///< s
  std::optional<double> to = {};  ///< s; none: the end of the run
  double reference = 1.0;         ///< in the unit of the statistic, which is divided by it
  double value = 0.0;             ///< of the quotient
  double tolerance = 0.0;         ///< relative to `value`, unless that is 0
};

/// Declares `history` of [verify].
void declare_history_checks(scene::Table& verify, std::vector<HistoryCheck>& checks);

/// Requires that a run until `end`, whose history.csv has `columns` beside the time, can be checked. Throws
/// `Failure` (invalid_scene).
void require_measurable(const scene::Place& root, const std::vector<HistoryCheck>& checks,
                        const OutputRequest& output, const EndTime& end,
                        const std::vector<run::Column>& columns);

/// Adds the checks of a run to its result, named `COLUMN_STATISTIC`, a second one of that name with `_1`, and
/// so on. A statistic, but for the last value, is NaN if the history begins after its interval. Throws
/// std::out_of_range for a column that the history lacks.
void add_history_checks(const std::vector<HistoryCheck>& checks, const run::History& history,
                        run::ResultDocument& result);

}  // namespace drogue::framework
