#include "common/run/result_document.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/program/provenance.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/version.hpp"

namespace drogue::run {
namespace {

using Json = nlohmann::ordered_json;

/// Null for NaN and infinity, which JSON lacks.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers_json(const std::map<std::string, double>& numbers) {
  Json json = Json::object();
  for (const auto& [name, value] : numbers) json[name] = number(value);
  return json;
}

Json checks_json(const std::vector<Check>& checks) {
  Json json = Json::array();
  for (const Check& check : checks) {
    json.push_back({{"name", check.name},
                    {"value", number(check.value)},
                    {"tolerance", number(check.tolerance)},
                    {"passed", check.passed}});
    if (check.measurement) json.back()["measured"] = number(check.measurement->value);
    if (check.rows) json.back()["rows"] = *check.rows;
    if (check.error) json.back()["error"] = number(*check.error);
  }
  return json;
}

Json group_json(const Metrics::Group& group) {
  Json json = Json::object();
  for (const auto& [name, value] : group.values) {
    if (const auto* count = std::get_if<std::int64_t>(&value))
      json[name] = *count;
    else if (const auto* real = std::get_if<double>(&value))
      json[name] = number(*real);
    else
      json[name] = std::get<std::string>(value);
  }
  return json;
}

Json timing_json(const ResultDocument::WallTimes& timing) {
  return {{"wall_s", number(timing.wall_s)},       {"setup_s", number(timing.setup_s)},
          {"compute_s", number(timing.compute_s)}, {"h2d_s", number(timing.h2d_s)},
          {"d2h_s", number(timing.d2h_s)},         {"io_s", number(timing.io_s)},
          {"bound_s", number(timing.bound_s)},     {"verify_s", number(timing.verify_s)}};
}

Json ledger_json(const ResultDocument::ProfilingCounters& ledger) {
  return {{"kernel_launches", ledger.kernel_launches},
          {"fences", ledger.fences},
          {"device_allocations_after_warmup", ledger.device_allocations_after_warmup},
          {"h2d_bytes", ledger.h2d_bytes},
          {"d2h_bytes", ledger.d2h_bytes}};
}

Json provenance_json(const ResultDocument::Provenance& provenance) {
  return {{"compiler", provenance.compiler}, {"flags", provenance.flags}, {"kokkos", provenance.kokkos},
          {"cpu", provenance.cpu},           {"gpu", provenance.gpu},     {"driver", provenance.driver},
          {"date", provenance.date}};
}

}  // namespace

std::string status_name(ExitCode code) {
  switch (code) {
    case ExitCode::ok:
      return "ok";
    case ExitCode::usage:
    case ExitCode::invalid_scene:
      return "invalid";
    case ExitCode::numerical_failure:
      return "numerical-failure";
    case ExitCode::verification_failed:
      return "verification-failed";
    case ExitCode::io_error:
      return "io-error";
    case ExitCode::no_backend:
      return "no-backend";
    case ExitCode::interrupted:
      return "interrupted";
  }
  return "io-error";
}

Metrics::Group& Metrics::at(const std::string& group) {
  const auto found = std::ranges::find(_groups, group, &Group::name);
  return found == _groups.end() ? _groups.emplace_back(Group{group, {}}) : *found;
}

void Metrics::add_group(const std::string& group) { (void)at(group); }

void Metrics::set(const std::string& group, const std::string& name, Value value) {
  auto& values = at(group).values;
  const auto found = std::ranges::find(values, name, &std::pair<std::string, Value>::first);
  if (found == values.end())
    values.emplace_back(name, std::move(value));
  else
    found->second = std::move(value);
}

std::int64_t Metrics::integer(const std::string& group, const std::string& name) const {
  return static_cast<std::int64_t>(real(group, name).value_or(0.0));
}

std::optional<double> Metrics::real(const std::string& group, const std::string& name) const {
  for (const Group& each : _groups)
    if (each.name == group)
      for (const auto& [key, value] : each.values)
        if (key == name) {
          if (const auto* real = std::get_if<double>(&value)) return *real;
          const auto* count = std::get_if<std::int64_t>(&value);
          return count != nullptr ? std::optional(static_cast<double>(*count)) : std::nullopt;
        }
  return std::nullopt;
}

std::string Check::measured() const {
  if (!measurement) return {};
  const auto& [quantity, lowest, highest] = *measurement;
  if (std::isnan(quantity)) return "not measured";
  // Two digits more than those in which the bounds differ.
  const double ratio = std::max(std::abs(lowest), std::abs(highest)) / (highest - lowest);
  const int digits = std::isfinite(ratio) ? std::clamp(3 + static_cast<int>(std::log10(ratio)), 5, 15) : 15;
  char text[128];
  std::snprintf(text, sizeof text, "%.*g%s in [%.*g, %.*g]", digits, quantity, passed ? "" : ", not", digits,
                lowest, digits, highest);
  return text;
}

bool ResultDocument::add_check(const std::string& name, double value, double tolerance,
                               const std::optional<Measurement>& measurement) {
  const bool passed = std::abs(value) <= tolerance;  // false for NaN
  checks.push_back({name, value, tolerance, passed, measurement});
  return passed;
}

void ResultDocument::add_deviation(const std::string& name, double quantity, double expected,
                                   double tolerance) {
  if (expected == 0.0) return add_distance(name, quantity, expected, tolerance);
  const double margin = std::abs(expected) * tolerance;
  add_check(name, std::abs(quantity / expected - 1.0), tolerance,
            Measurement{quantity, expected - margin, expected + margin});
}

void ResultDocument::add_distance(const std::string& name, double quantity, double expected,
                                  double tolerance) {
  add_check(name, std::abs(quantity - expected), tolerance,
            Measurement{quantity, expected - tolerance, expected + tolerance});
}

void ResultDocument::state_rows(std::size_t rows, double period) {
  constexpr std::size_t least_rows = 10;
  constexpr double least_in_period = 8.0;
  checks.back().rows = static_cast<std::int64_t>(rows);
  const bool is_coarse = period > 0.0 && period < least_in_period;
  if (rows >= least_rows && !is_coarse) return;
  char text[256];
  if (is_coarse)
    std::snprintf(text, sizeof text, "%s is computed from %.2g rows of history.csv in a period",
                  checks.back().name.c_str(), period);
  else
    std::snprintf(text, sizeof text, "%s is computed from %zu row%s of history.csv",
                  checks.back().name.c_str(), rows, rows == 1 ? "" : "s");
  warnings.push_back(std::string(text) +
                     ", which may miss what lies between them; a smaller output.history_every has more");
}

std::string ResultDocument::failed_check() const {
  const auto failed =
      std::find_if(checks.begin(), checks.end(), [](const Check& check) { return !check.passed; });
  if (failed == checks.end()) return {};
  char text[384];
  if (std::isnan(failed->value))
    std::snprintf(
        text, sizeof text,
        "%s could not be measured in this run, perhaps because it is too short, continues one without its "
        "history.csv, or is relative to a value of 0; its tolerance is %.6g",
        failed->name.c_str(), failed->tolerance);
  else if (failed->measurement)
    std::snprintf(text, sizeof text, "%s is %s: its deviation is %.6g, above its tolerance %.6g",
                  failed->name.c_str(), failed->measured().c_str(), failed->value, failed->tolerance);
  else
    std::snprintf(text, sizeof text, "%s is %.6g, above its tolerance %.6g", failed->name.c_str(),
                  failed->value, failed->tolerance);
  return text;
}

ResultDocument new_result(const std::string& program, const std::string& scene) {
  const BuildInfo& build = build_info();
  ResultDocument result;
  result.program = program;
  result.scene = scene;
  result.version = build.version;
  result.git = build.git;
  result.provenance.compiler = build.compiler;
  result.provenance.flags = build.flags;
  result.provenance.kokkos = build.kokkos;
  result.provenance.cpu = cpu_model();
  result.provenance.date = utc_date();
  return result;
}

std::string to_json(const ResultDocument& result) {
  Json json;
  json["schema"] = "drogue.result/1";
  json["program"] = result.program;
  json["version"] = result.version;
  json["git"] = result.git;
  json["scene"] = result.scene;
  if (!result.fingerprint.empty()) json["fingerprint"] = result.fingerprint;
  json["backend"] = result.backend;
  json["device"] = result.device;
  json["precision"] = result.precision;
  json["driver"] = result.driver;
  json["ranks"] = result.ranks;
  json["threads"] = result.threads;
  json["status"] = status_name(result.exit_code);
  json["exit_code"] = static_cast<int>(result.exit_code);
  json["message"] = result.message;
  json["steps"] = result.steps;
  json["time"] = number(result.time);
  json["dt_min"] = number(result.dt_min);
  json["dt_max"] = number(result.dt_max);
  json["errors"] = numbers_json(result.errors);
  json["checks"] = checks_json(result.checks);
  if (!result.warnings.empty()) json["warnings"] = result.warnings;
  for (const Metrics::Group& group : result.metrics.groups())
    if (!group.values.empty()) json[group.name] = group_json(group);
  json["timing"] = timing_json(result.timing);
  json["ledger"] = ledger_json(result.ledger);
  json["peak_bytes"] = {{"host", result.peak_bytes.host}, {"device", result.peak_bytes.device}};
  json["provenance"] = provenance_json(result.provenance);
  // File names and messages may hold invalid UTF-8, which is replaced.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void record_failure(ResultDocument& result, const Failure& failure, const std::function<void()>& write) {
  result.exit_code = failure.code();
  result.message = failure.what();
  try {
    write();
  } catch (const Failure& second) {
    throw Failure(failure.code(), std::string(failure.what()) + "; and " + second.what());
  }
}

std::optional<double> time_of_finished_run(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) return {};
  const auto status = json.find("status"), time = json.find("time");
  const bool has_finished = status != json.end() && (*status == status_name(ExitCode::ok) ||
                                                     *status == status_name(ExitCode::verification_failed));
  if (!has_finished || time == json.end() || !time->is_number()) return {};
  return time->get<double>();
}

void write_result(const std::filesystem::path& file, ResultDocument result) {
  result.peak_bytes.host = host_peak_bytes();
  write_file_atomically(file, to_json(result));
}

}  // namespace drogue::run
