#include "miniapps/framework/scene_keys.hpp"

#include <algorithm>

namespace drogue::framework {

using scene::between, scene::not_negative;

double next_stop(const OutputRequest& output, double time, double end_time) {
  const auto later = std::ranges::find_if(output.times, [time](double each) { return each > time; });
  return later == output.times.end() ? end_time : std::min(*later, end_time);
}

bool is_output_time(const OutputRequest& output, double time) {
  return std::ranges::find(output.times, time) != output.times.end();
}

void declare_app(scene::Table& root, const std::string& name, std::string& description) {
  root.value("app", scene::fixed_codec(name), "The program the scene is for",
             {.required = true, .decisive = true});
  root.value("description", scene::text_codec(description), "Sentence for --list-scenes");
}

void declare_output_times(scene::Table& table, OutputRequest& output, const scene::Key& fields) {
  table.value("times", scene::reals_codec(output.times, 0, true), "Times at which fields are written",
              {.unit = "s",
               .range = not_negative,
               .when = {[&output, &fields] {
                          return !output.fields.empty() || (!fields.given() && !output.times.empty());
                        },
                        "with fields", "fields"},
               .default_text = "the end time where fields are given"});
}

void declare_output_intervals(scene::Table& table, OutputRequest& output) {
  table.value("history_every", output.history_every, "Steps between rows of history.csv; 0: none",
              {.range = between(0, 1e9)});
  table.value("restart_every", output.restart_every,
              "Steps between restart files; 0: none, not even at the end of the run",
              {.range = between(0, 1e9), .default_text = "none between; one at the end"});
}

void declare_output(scene::Table& table, OutputRequest& output, const std::vector<std::string>& names) {
  const scene::Key& fields =
      table.value("fields", scene::names_codec(output.fields, names), "Fields written to fields.h5",
                  {.default_text = "all of them where times are given, else none"});
  declare_output_times(table, output, fields);
  declare_output_intervals(table, output);
}

void complete_output(const scene::Place& root, OutputRequest& output,
                     const std::vector<std::string>& default_fields, const EndTime& end) {
  if (!output.times.empty() && output.fields.empty()) output.fields = default_fields;
  if (!output.fields.empty() && !root.given("output.times")) output.times = {end.time};
  root.refuse_if(!output.fields.empty() && output.times.empty(), "output.times",
                 " is empty, yet output.fields names fields");
  if (!output.times.empty() && output.times.back() > end.time)
    root.refuse("output.times", ": ", output.times.back(), " is later than ", end.key, " = ", end.time);
}

std::string too_many_steps(const scene::Place& root, const std::string& what, double dt, double end_time,
                           std::int64_t most) {
  const double steps = end_time / dt;
  if (steps <= static_cast<double>(most) || root.given("run.max_steps")) return {};
  return scene::sentence(what, scene::rough_text(dt), " s: ", scene::rough_text(steps),
                         " steps to run.end_time, more than run.max_steps = ", most);
}

}  // namespace drogue::framework
