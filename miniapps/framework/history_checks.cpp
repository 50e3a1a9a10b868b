#include "miniapps/framework/history_checks.hpp"

#include <algorithm>
#include <map>

#include "common/run/uncertainty.hpp"
#include "common/scene/codec.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"
#include "common/scene/read.hpp"

namespace drogue::framework {
namespace {

using run::Statistic;
using scene::not_negative, scene::positive;

const scene::Choices<Statistic> statistic_choices = {{"mean", Statistic::mean},
                                                     {"max", Statistic::max},
                                                     {"min", Statistic::min},
                                                     {"last", Statistic::last},
                                                     {"frequency", Statistic::frequency},
                                                     {"amplitude", Statistic::amplitude}};

void declare_check(scene::Table& table, HistoryCheck& check) {
  table.value("column", scene::text_codec(check.column), "Column of history.csv, without its unit",
              {.required = true});
  table.value(
      "statistic", check.statistic, statistic_choices,
      "Mean by the trapezoidal rule, largest or least value in rows of the interval, value at its end by "
      "linear interpolation, frequency (1/s) at which they cross their mean upwards, or half of their "
      "range, whose ends are vertices of parabolas through three rows",
      {.required = true});
  table.value("from", check.from, "Begin of the interval", {.unit = "s", .range = not_negative});
  table.value("to", check.to, "End of the interval",
              {.unit = "s", .range = positive, .default_text = "the end of the run"});
  table.value("reference", check.reference,
              "Value by which the statistic is divided, in its unit: half of density, squared speed and area "
              "for a drag coefficient, speed over width for a Strouhal number",
              {.range = positive});
  table.value("value", check.value, "Expected value of the quotient", {.required = true});
  table.value("tolerance", check.tolerance,
              "Largest relative deviation that passes, or largest magnitude if `value` is 0",
              {.range = not_negative, .required = true});
}

}  // namespace

void declare_history_checks(scene::Table& verify, std::vector<HistoryCheck>& checks) {
  verify.tables("history", checks, declare_check,
                "Statistics of columns of history.csv over intervals of time");
}

void require_measurable(const scene::Place& root, const std::vector<HistoryCheck>& checks,
                        const OutputRequest& output, const EndTime& end,
                        const std::vector<run::Column>& columns) {
  std::vector<std::string> names;
  for (const run::Column& column : columns) names.push_back(column.name);
  for (const auto& [at, check] : root.each("verify.history", checks)) {
    at.refuse_if(output.history_every == 0, "", " needs rows of the history; output.history_every is 0");
    if (std::ranges::find(names, check.column) == names.end())
      at.refuse("column", " = \"", check.column, "\" is no column of the history.csv of this scene; ",
                scene::suggestion(check.column, names));
    if (check.to && !(check.from < *check.to && *check.to <= end.time))
      at.refuse("to", " = ", *check.to, " s must lie between from and ", end.key, " = ", end.time, " s");
    at.refuse_if(check.from >= end.time, "from", " = ", check.from, " s must be before ", end.key, " = ",
                 end.time, " s");
    at.refuse_if(check.statistic == Statistic::frequency && !(check.value > 0.0), "value",
                 " must be positive: it is a frequency");
    at.refuse_if(check.statistic == Statistic::amplitude && check.value < 0.0, "value",
                 " must not be negative: it is an amplitude");
  }
}

void add_history_checks(const std::vector<HistoryCheck>& checks, const run::History& history,
                        run::ResultDocument& result) {
  const std::vector<double>& time = history.at("time");
  std::map<std::string, int> earlier;  // checks of the same name
  for (const HistoryCheck& check : checks) {
    const double end = check.to.value_or(run::never);
    const run::HistoryRows all = {time, history.at(check.column)};
    const run::HistoryRows rows = run::rows_between(all, check.from, end);
    const double statistic = run::statistic_of(check.statistic, all, check.from, end);
    std::string name = check.column + "_" + scene::choice_name(statistic_choices, check.statistic);
    if (const int count = earlier[name]++; count > 0) name += "_" + std::to_string(count);
    result.add_deviation(name, statistic / check.reference, check.value, check.tolerance);
    if (check.statistic == Statistic::mean && rows.time.size() > 1)
      result.checks.back().error =
          run::batch_half_width([&](double from, double to) { return run::mean_between(all, from, to); },
                                check.from, rows.time.back()) /
          check.reference;
    const double period = check.statistic == Statistic::frequency || check.statistic == Statistic::amplitude
                              ? run::rows_in_period(rows, run::frequency_of(rows))
                              : 0.0;
    // The last value of the run is one row, whatever others there are.
    if (check.statistic != Statistic::last || check.to) result.state_rows(rows.time.size(), period);
  }
}

}  // namespace drogue::framework
