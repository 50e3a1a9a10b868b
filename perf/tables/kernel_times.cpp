#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "perf/measure/record.hpp"
#include "perf/profile/kernel_profile.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

struct KernelTime {
  std::string name;  ///< "flow::MomentumFunctor"; of a library the name of its function
  std::string area;  ///< "flow"; "library"
  int launches = 0;
  double seconds = 0.0;
};

KernelTime time_of(const KernelProfile& kernel) {
  const std::string name = kernel.name();
  return {name, kernel.is_own() ? name.substr(0, name.find("::")) : "library", kernel.launches,
          kernel.duration};
}

/// Times by `key`, largest first.
std::vector<KernelTime> sums(const std::vector<KernelTime>& kernels, std::string KernelTime::*key) {
  std::map<std::string, KernelTime> by_key;
  for (const KernelTime& kernel : kernels) {
    KernelTime& sum = by_key[kernel.*key];
    sum.name = kernel.*key;
    sum.launches += kernel.launches;
    sum.seconds += kernel.seconds;
  }
  std::vector<KernelTime> list;
  for (const auto& [name, sum] : by_key) list.push_back(sum);
  std::ranges::stable_sort(list, std::greater<>{}, &KernelTime::seconds);
  return list;
}

}  // namespace

Table print_kernel_times(const std::string& profile, const nlohmann::json& provenance) {
  std::vector<KernelTime> kernels;
  for (const KernelProfile& kernel : read_profiles(profile)) kernels.push_back(time_of(kernel));
  double total = 0.0;
  for (const KernelTime& kernel : kernels) total += kernel.seconds;
  if (total == 0.0)
    throw Failure(ExitCode::invalid_scene,
                  profile + ": no launch has a duration; drogue-perf ncu prints a command that measures it");
  Table table;
  std::printf(
      "Time of the profiled launches of %s: durations of single kernels, without the gaps between them\n\n"
      "%-44s %9s %12s %12s %8s\n",
      profile.c_str(), "kernel", "launches", "us", "per launch", "%");
  const auto print = [&](const KernelTime& sum, const std::string& label) {
    std::printf("%-44s %9d %12.1f %12.2f %8.1f\n", label.c_str(), sum.launches, 1e6 * sum.seconds,
                1e6 * sum.seconds / sum.launches, 100.0 * sum.seconds / total);
    table.add({"kernels/" + sum.name, "profile", "the profiled launches"}, provenance,
              {{"launches", sum.launches}, {"seconds", sum.seconds}, {"share", sum.seconds / total}});
  };
  for (const KernelTime& sum : sums(kernels, &KernelTime::area)) print(sum, "all of " + sum.name);
  std::printf("\n");
  for (const KernelTime& sum : sums(kernels, &KernelTime::name)) print(sum, sum.name);
  return table;
}

}  // namespace drogue::perf
