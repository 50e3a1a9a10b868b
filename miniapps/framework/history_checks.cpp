#include "miniapps/framework/history_checks.hpp"

#include <algorithm>
#include <map>

#include "common/scene/codec.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"
#include "common/scene/read.hpp"

namespace drogue::framework {
namespace {

using run::Statistic;

const scene::Choices<Statistic> statistic_choices = {{"mean", Statistic::mean},
                                                     {"max", Statistic::max},
                                                     {"min", Statistic::min},
                                                     {"last", Statistic::last},
                                                     {"frequency", Statistic::frequency},
                                                     {"amplitude", Statistic::amplitude}};

void declare_check(scene::Table& table, HistoryCheck& check) {
  table.value("column", scene::text_codec(check.column), "Column of history.csv, without its unit")
      .required();
  table
      .value(
          "statistic", scene::choice_codec(check.statistic, statistic_choices),
          "Mean by the trapezoidal rule, largest or least value in rows of the interval, value at its end by "
          "linear interpolation, frequency (1/s) at which they cross their mean upwards, or half of their "
          "range, whose ends are vertices of parabolas through three rows")
      .required();
  table.value("from", scene::real_codec(check.from), "Begin of the interval").unit("s").at_least(0.0);
  table.value("to", scene::real_codec(check.to), "End of the interval")
      .unit("s")
      .above(0.0)
      .default_text("the end of the run");
  table
      .value("reference", scene::real_codec(check.reference),
             "Value by which the statistic is divided, in its unit: half of density, squared speed and area "
             "for a drag coefficient, speed over width for a Strouhal number")
      .above(0.0);
  table.value("value", scene::real_codec(check.value), "Expected value of the quotient").required();
  table
      .value("tolerance", scene::real_codec(check.tolerance),
             "Largest relative deviation that passes, or largest magnitude if `value` is 0")
      .at_least(0.0)
      .required();
}

}  // namespace

void declare_history_checks(scene::Table& verify, std::vector<HistoryCheck>& checks) {
  verify.tables("history", checks, declare_check,
                "Statistics of columns of history.csv over intervals of time");
}

void require_measurable(const scene::Table& root, const std::vector<HistoryCheck>& checks,
                        const OutputRequest& output, const EndTime& end,
                        const std::vector<run::Column>& columns) {
  std::vector<std::string> names;
  for (const run::Column& column : columns) names.push_back(column.name);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const HistoryCheck& check = checks[i];
    const std::string path = "verify.history[" + std::to_string(i) + "]";
    const auto refuse = [&](const std::string& key, const std::string& sentence) {
      scene::contradict(root, path + key, path + key + sentence);
    };
    if (output.history_every == 0) refuse("", " needs rows of the history; output.history_every is 0");
    if (std::ranges::find(names, check.column) == names.end())
      refuse(".column", " = \"" + check.column + "\" is no column of the history.csv of this scene; " +
                            scene::suggestion(check.column, names));
    const std::string end_text = std::string(end.key) + " = " + scene::real_text(end.time) + " s";
    if (check.to && !(check.from < *check.to && *check.to <= end.time))
      refuse(".to", " = " + scene::real_text(*check.to) + " s must lie between from and " + end_text);
    if (check.from >= end.time)
      refuse(".from", " = " + scene::real_text(check.from) + " s must be before " + end_text);
    const bool is_frequency = check.statistic == Statistic::frequency;
    if (is_frequency && !(check.value > 0.0)) refuse(".value", " must be positive: it is a frequency");
    if (check.statistic == Statistic::amplitude && check.value < 0.0)
      refuse(".value", " must not be negative: it is an amplitude");
    if (check.value != 0.0 && check.tolerance > 1.0)
      refuse(".tolerance", " is relative to value: above 1 it accepts the opposite sign too");
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
    const double period = check.statistic == Statistic::frequency || check.statistic == Statistic::amplitude
                              ? run::rows_in_period(rows, run::frequency_of(rows))
                              : 0.0;
    // The last value of the run is one row, whatever others there are.
    if (check.statistic != Statistic::last || check.to) result.state_rows(rows.time.size(), period);
  }
}

}  // namespace drogue::framework
