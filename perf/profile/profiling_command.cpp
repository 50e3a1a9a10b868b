#include <algorithm>
#include <array>
#include <utility>

#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"
#include "perf/process/shell_word.hpp"
#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {
namespace {

/// Kinds of cases with the namespaces of their kernels.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kinds = {
    {{"gas-step", "gas"},
     {"springs-step", "fabric"},
     {"springs-contact", "fabric"},
     {"options", "options"},
     {"options-surface", "options"},
     {"options-cos", "options"},
     {"flow-step", "(flow|linear)"},
     {"flow-pressure", "linear"},
     {"parachute-flight", "(coupling|fabric|flow|linear)"},
     {"tridiagonal", "perf"},
     {"ceiling", "perf"}}};

/// Launch parameters, limits of occupancy and mean occupancy: one pass, so no kernel is run again.
constexpr std::array metrics = {"launch__block_size",
                                "launch__grid_size",
                                "launch__registers_per_thread",
                                "launch__shared_mem_config_size",
                                "launch__shared_mem_per_block_dynamic",
                                "launch__shared_mem_per_block_static",
                                "launch__waves_per_multiprocessor",
                                "launch__occupancy_limit_blocks",
                                "launch__occupancy_limit_registers",
                                "launch__occupancy_limit_shared_mem",
                                "launch__occupancy_limit_warps",
                                "device__attribute_compute_capability_major",
                                "device__attribute_compute_capability_minor",
                                "device__attribute_display_name",
                                "device__attribute_multiprocessor_count",
                                "sm__maximum_warps_per_active_cycle_pct",
                                "sm__warps_active.avg.pct_of_peak_sustained_active",
                                "gpu__time_duration.sum"};

std::string_view namespaces_of(const std::string& case_name) {
  const std::string kind = case_name.substr(0, case_name.find('/'));
  const auto found = std::ranges::find(kinds, kind, &decltype(kinds)::value_type::first);
  if (found != kinds.end()) return found->second;
  throw Failure(ExitCode::usage, "there is no case '" + case_name + "': of its kind '" + kind + "' " +
                                     scene::suggestion(kind, case_kinds()));
}

}  // namespace

std::vector<std::string> case_kinds() {
  std::vector<std::string> names;
  for (const auto& [name, spaces] : kinds) names.emplace_back(name);
  return names;
}

std::string kernels_of_case(const std::string& case_name) {
  const std::string_view spaces = namespaces_of(case_name);
  if (("/" + case_name + "/").find("/cuda/") == std::string::npos)
    throw Failure(ExitCode::usage,
                  "'" + case_name + "' is no case on cuda, and ncu profiles kernels of CUDA alone");
  return "drogue::" + std::string(spaces);
}

std::string profiling_command(const std::vector<std::string>& command, const std::string& out,
                              const ProfiledLaunches& launches) {
  std::string names;
  for (const char* metric : metrics) names += (names.empty() ? "" : ",") + std::string(metric);
  std::vector<std::string> words = {
      // Exact numbers and whole names: rounded bytes and shortened templates would be ambiguous.
      "--csv", "--page", "raw", "--print-units", "base", "--print-kernel-base", "demangled",
      "--rename-kernels", "no", "--kernel-name-base", "demangled", "--kernel-name",
      "regex:" + launches.kernels, "--launch-skip", std::to_string(launches.skip), "--launch-count",
      std::to_string(launches.count), "--kill", "yes", "--graph-profiling", "node",
      // As in a run without a profiler.
      "--clock-control", "none", "--cache-control", "none", "--metrics", names, "--log-file", out};
  words.insert(words.end(), command.begin(), command.end());
  std::string text = "ncu";
  for (const std::string& word : words) text += " " + shell_word(word);
  return text;
}

}  // namespace drogue::perf
