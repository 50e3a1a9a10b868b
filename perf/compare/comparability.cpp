#include "perf/compare/comparability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

namespace drogue::perf {

namespace {

/// Facts that describe the work; others are results.
constexpr const char* size_facts[] = {"backend", "cells",    "variant", "block",     "form",
                                      "grid",    "sides",    "solver",  "mesh",      "method",
                                      "memory",  "substeps", "problem", "precision", "tolerance"};
constexpr double largest_clock_change = 0.02;

std::string text_of(const nlohmann::json& value) {
  if (value.is_null()) return "unknown";
  return value.is_string() ? "'" + value.get<std::string>() + "'"
                           : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Entry of an object, null if it is absent or there is no object.
nlohmann::json entry(const nlohmann::json& object, const char* key) {
  return object.is_object() ? object.value(key, nlohmann::json()) : nlohmann::json();
}

/// Difference of an entry of two objects.
std::optional<std::string> difference(const char* words, const char* key, const nlohmann::json& before,
                                      const nlohmann::json& after) {
  const nlohmann::json a = entry(before, key), b = entry(after, key);
  if (a == b) return std::nullopt;
  return "other " + std::string(words) + ": " + text_of(a) + ", now " + text_of(b);
}

bool is_on_gpu(const MeasuredCase& record) { return entry(record.facts, "backend") == "cuda"; }

std::optional<std::string> clock_difference(const MeasuredCase& before, const MeasuredCase& after) {
  for (const auto& [key, words] : {std::pair("sm_mhz", "clock of the GPU (MHz)"),
                                   std::pair("memory_mhz", "clock of the memory of the GPU (MHz)")}) {
    const nlohmann::json a = entry(before.clocks, key), b = entry(after.clocks, key);
    if (!a.is_number() || !b.is_number()) continue;
    const double old_clock = a.get<double>(), new_clock = b.get<double>();
    if (std::abs(new_clock - old_clock) > largest_clock_change * std::max(old_clock, new_clock))
      return difference(words, key, before.clocks, after.clocks);
  }
  return std::nullopt;
}

bool agree(double a, double b) {
  constexpr double relative = 1e-6, rounding = 1e-9, least = 1e-15, factor = 10.0;
  const double low = std::min(std::abs(a), std::abs(b)), high = std::max(std::abs(a), std::abs(b));
  return std::abs(a - b) <= relative * high || (high < rounding && high <= factor * std::max(low, least));
}

std::optional<std::string> value_change(const char* words, const std::optional<double>& before,
                                        const std::optional<double>& after) {
  if (!before && !after) return std::nullopt;
  if (before && after && agree(*before, *after)) return std::nullopt;
  const auto text = [](const std::optional<double>& value) {
    if (!value) return std::string("not finite");
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.4g", *value);
    return std::string(digits);
  };
  return std::string(words) + " " + text(before) + ", now " + text(after);
}

std::optional<double> number(const nlohmann::json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

}  // namespace

std::optional<std::string> why_not_comparable(const MeasuredCase& before, const MeasuredCase& after) {
  const auto& [old_origin, new_origin] = std::tie(before.provenance, after.provenance);
  if (auto found = difference("processor", "cpu", old_origin, new_origin)) return found;
  if (auto found = difference("GPU", "gpu", old_origin, new_origin)) return found;
  if (auto found = difference("number of threads", "threads", old_origin, new_origin)) return found;
  if (auto found = difference("compiler flags", "flags", old_origin, new_origin)) return found;
  if (before.cold_caches != after.cold_caches)
    return std::string("other caches: ") + (before.cold_caches ? "cold, now warm" : "warm, now cold");
  if (before.unit != after.unit) return "other unit: '" + before.unit + "', now '" + after.unit + "'";
  for (const char* fact : size_facts)
    if (auto found = difference(fact, fact, before.facts, after.facts)) return found;
  return is_on_gpu(after) ? clock_difference(before, after) : std::nullopt;
}

std::optional<std::string> error_change(const MeasuredCase& before, const MeasuredCase& after) {
  if (before.passed != after.passed) {
    const std::optional<std::string> change = value_change("error", before.error, after.error);
    return std::string("check ") + (after.passed ? "failed, now passed" : "passed, now failed") +
           (change ? ": " + *change : "");
  }
  if (auto found = value_change("error", before.error, after.error)) return found;
  const std::optional<double> old_error = number(entry(before.facts, "solution_error"));
  const std::optional<double> new_error = number(entry(after.facts, "solution_error"));
  return old_error && new_error ? value_change("error of the solution", old_error, new_error) : std::nullopt;
}

}  // namespace drogue::perf
