#include "common/study/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "common/study/axis_text.hpp"

namespace drogue::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr int most_runs = 10000, most_jobs = 1024;
constexpr double least_factor = 0.1, most_factor = 10.0, least_ratio = 1.1;
const std::vector<std::string> axis_names = {"ensemble", "cells", "jobs"};

int count_of(const std::string& key, const std::string& text, int most) {
  const std::optional<int> count = number_of<int>(text);
  if (!count || *count < 1 || *count > most)
    refuse(key + "=" + text + " is not an integer between 1 and " + std::to_string(most));
  return *count;
}

std::vector<double> factors_of(const std::string& text) {
  std::vector<double> factors;
  for (const std::string& part : split(text, ':')) {
    const std::optional<double> factor = number_of<double>(part);
    if (!factor || !(*factor >= least_factor && *factor <= most_factor))
      refuse("cells=" + text + ": '" + part + "' is no factor of the numbers of cells between 0.1 and 10");
    factors.push_back(*factor);
  }
  if (factors.size() > 2) refuse("cells=" + text + " names more than two grids");
  if (factors.size() == 2 && factors[1] < least_ratio * factors[0])
    refuse("cells=" + text +
           ": the second grid must have at least 1.1 times as many cells along each axis as the first; "
           "closer ones show scatter alone");
  return factors;
}

double real_at(const Json& json, const std::string& name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_number() ? found->get<double>() : unknown;
}

/// Numbers of a group that are results of the run, with their errors.
void add_group(const std::string& group, const Json& values, std::vector<Quantity>& quantities) {
  for (const auto& [name, value] : values.items())
    if (value.is_number() && name != "from" && name != "frontal_area" && !name.ends_with("_error"))
      quantities.push_back({group + "." + name, value.get<double>(), real_at(values, name + "_error")});
}

std::vector<Quantity> quantities_of(const Json& json) {
  std::vector<Quantity> quantities;
  for (const auto& [group, values] : json.items())
    if ((group.starts_with("canopy_") || group.starts_with("body_")) && values.is_object())
      add_group(group, values, quantities);
  if (const auto checks = json.find("checks"); checks != json.end())
    for (const Json& check : *checks)
      if (const double measured = real_at(check, "measured"); std::isfinite(measured))
        quantities.push_back({check.value("name", ""), measured, real_at(check, "error")});
  return quantities;
}

ExitCode code_of(int code) {
  for (const ExitCode known :
       {ExitCode::ok, ExitCode::usage, ExitCode::invalid_scene, ExitCode::numerical_failure,
        ExitCode::verification_failed, ExitCode::io_error, ExitCode::no_backend, ExitCode::interrupted})
    if (static_cast<int>(known) == code) return known;
  return ExitCode::io_error;
}

/// Names of all quantities, in the order of the first run that has them.
std::vector<std::string> names_of(const std::vector<Member>& members) {
  std::vector<std::string> names;
  for (const Member& member : members)
    for (const Quantity& quantity : member.quantities)
      if (std::ranges::find(names, quantity.name) == names.end()) names.push_back(quantity.name);
  return names;
}

run::Distribution distribution_on(std::size_t grid, const std::string& name,
                                  const std::vector<Member>& members) {
  std::vector<double> values, half_widths;
  for (const Member& member : members) {
    if (member.grid != grid) continue;
    const auto found = std::ranges::find(member.quantities, name, &Quantity::name);
    if (found == member.quantities.end()) continue;
    values.push_back(found->value);
    if (std::isfinite(found->half_width)) half_widths.push_back(found->half_width);
  }
  return values.empty() ? run::Distribution{} : run::distribution_of(values, half_widths);
}

std::string key_of(std::string name) {
  std::ranges::replace(name, '.', '_');
  return name;
}

}  // namespace

bool is_ensemble(const std::string& text, const std::vector<std::string>& others) {
  std::vector<std::string> all = axis_names;
  all.insert(all.end(), others.begin(), others.end());
  bool is_one = false;
  std::string other;
  for (const std::string& part : split(text, ',')) {
    const std::string name = part.substr(0, part.find('='));
    require_one_of(name, all);
    if (std::ranges::find(axis_names, name) != axis_names.end())
      is_one = true;
    else
      other = name;
  }
  if (is_one && !other.empty())
    refuse(other +
           " cannot be combined with ensemble, cells and jobs; cells=1:2 names two grids, the second " +
           "with twice as many cells along each axis");
  return is_one;
}

EnsembleAxes parse_ensemble(const std::string& text) {
  EnsembleAxes axes;
  for (const auto& [name, value] : axis_texts(text, axis_names)) {
    if (name == "ensemble") axes.runs = count_of(name, value, most_runs);
    if (name == "jobs") axes.jobs = count_of(name, value, most_jobs);
    if (name == "cells") axes.factors = factors_of(value);
  }
  return axes;
}

void read_member(const std::filesystem::path& result, int exit_code, const std::string& log, Member& member) {
  std::ifstream stream(result);
  const Json json = Json::parse(stream, nullptr, false);
  member.code = code_of(exit_code);
  if (!json.is_object()) {
    // A process that ends well leaves the file.
    if (member.is_finished()) member.code = ExitCode::io_error;
    member.message =
        log.empty() ? "it ended with code " + std::to_string(exit_code) + " and left no result.json" : log;
    return;
  }
  if (json.value("exit_code", exit_code) != exit_code) {
    member.code = exit_code == 0 ? ExitCode::io_error : member.code;
    member.message = log.empty() ? "it ended with code " + std::to_string(exit_code) +
                                       ", which its result.json does not have"
                                 : log;
    return;
  }
  member.message = json.value("message", "");
  member.backend = json.value("backend", "");
  member.device = json.value("device", "");
  member.threads = json.value("threads", 1);
  member.steps = json.value("steps", std::int64_t{0});
  if (const auto timing = json.find("timing"); timing != json.end())
    member.wall_s = real_at(*timing, "wall_s");
  if (member.is_finished()) member.quantities = quantities_of(json);
}

std::optional<Origin> read_finished(const std::filesystem::path& result, Member& member) {
  std::ifstream stream(result);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  Member stored = member;
  read_member(result, json.value("exit_code", -1), "", stored);
  if (!stored.is_finished()) return std::nullopt;
  member = stored;
  return Origin{json.value("version", ""), json.value("git", ""), json.value("fingerprint", "")};
}

std::vector<StudyQuantity> summarize(const std::vector<Member>& members, const std::vector<double>& factors) {
  std::vector<StudyQuantity> all;
  for (const std::string& name : names_of(members)) {
    StudyQuantity quantity{name, {}, {}};
    for (std::size_t grid = 0; grid < factors.size(); ++grid)
      quantity.grids.push_back(distribution_on(grid, name, members));
    const run::Distribution &coarse = quantity.grids.front(), &fine = quantity.grids.back();
    if (fine.runs == 0) continue;
    quantity.bar = factors.size() > 1 && coarse.runs > 0
                       ? run::error_bar(coarse, fine, factors.back() / factors.front())
                       : run::error_bar(fine);
    all.push_back(std::move(quantity));
  }
  return all;
}

std::string text_of(const StudyQuantity& quantity) {
  const run::ErrorBar& bar = quantity.bar;
  const run::Distribution& fine = quantity.grids.back();
  const bool has_grid = quantity.grids.size() > 1 && quantity.grids.front().runs > 0;
  std::string text =
      run::bar_text(bar.value, bar.half_width) + " (sampling " +
      (std::isfinite(bar.sampling) ? run::number_text(bar.sampling, 2) : "not known") + ", grid " +
      (has_grid && std::isfinite(bar.grid) ? run::number_text(bar.grid, 2) : "not known") + ")";
  if (quantity.name.find("peak") == std::string::npos || fine.runs < 2) return text;
  return text + "; of a run: standard deviation " + run::number_text(fine.deviation, 3) + ", 5 to 95 % " +
         run::number_text(fine.lowest, 4) + " to " + run::number_text(fine.highest, 4);
}

std::string members_csv(const std::vector<Member>& members, const std::vector<double>& factors) {
  const std::vector<std::string> names = names_of(members);
  std::ostringstream text;
  text.precision(9);
  text << "folder,cells,seed,status,steps,wall_s";
  for (const std::string& name : names) text << ',' << name;
  text << '\n';
  for (const Member& member : members) {
    text << member.folder << ',' << factors.at(member.grid) << ',' << member.seed << ','
         << run::status_name(member.code) << ',' << member.steps << ',' << member.wall_s;
    for (const std::string& name : names) {
      text << ',';
      const auto found = std::ranges::find(member.quantities, name, &Quantity::name);
      if (found != member.quantities.end()) text << found->value;
    }
    text << '\n';
  }
  return text.str();
}

void describe(const EnsembleAxes& axes, const std::vector<Member>& members,
              const std::vector<StudyQuantity>& quantities, run::Metrics& metrics) {
  const auto set = [&](const std::string& name, run::Metrics::Value value) {
    metrics.set("study", name, std::move(value));
  };
  const auto finished = std::ranges::count_if(members, &Member::is_finished),
             interrupted = std::ranges::count(members, ExitCode::interrupted, &Member::code);
  set("runs", static_cast<std::int64_t>(members.size()));
  set("finished", static_cast<std::int64_t>(finished));
  set("failed", static_cast<std::int64_t>(members.size()) - finished - interrupted);
  set("cells", axes.factors.back());
  if (axes.factors.size() > 1) set("coarse_cells", axes.factors.front());
  for (const StudyQuantity& quantity : quantities) {
    const std::string name = key_of(quantity.name);
    const run::Distribution& fine = quantity.grids.back();
    const bool lacks_grid = quantity.grids.size() > 1 && quantity.grids.front().runs == 0;
    set(name, quantity.bar.value);
    set(name + "_error", lacks_grid ? unknown : quantity.bar.half_width);
    set(name + "_sampling", quantity.bar.sampling);
    if (quantity.grids.size() > 1) {
      set(name + "_grid", lacks_grid ? unknown : quantity.bar.grid);
      set(name + "_coarse", quantity.grids.front().runs > 0 ? quantity.grids.front().mean : unknown);
    }
    set(name + "_runs", static_cast<std::int64_t>(fine.runs));
    set(name + "_deviation", fine.deviation);
    set(name + "_p05", fine.lowest);
    set(name + "_p95", fine.highest);
  }
}

}  // namespace drogue::study
