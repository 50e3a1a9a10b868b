#include "perf/measurement.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace drogue::perf {

std::vector<Case> all_cases(bool quick) {
  std::vector<Case> cases = gas_cases(quick);
  for (std::vector<Case> more : {fabric_cases(quick), contact_cases(quick), options_cases(quick),
                                 tridiagonal_cases(quick), ceiling_cases()})
    std::ranges::move(more, std::back_inserter(cases));
  return cases;
}

std::vector<Record> measure(const std::vector<Case>& cases, int warm_up, int rounds) {
  std::vector<Record> records;
  std::vector<Sample> samples;
  for (const Case& c : cases) {
    records.push_back({c.name, c.unit_of_work, c.bound, {}, 0.0, c.tolerance, {}, {}});
    samples.push_back(c.prepare());
  }
  for (int round = -warm_up; round < rounds; ++round)
    for (std::size_t i = 0; i < cases.size(); ++i) {
      samples[i].reset();
      const auto begin = std::chrono::steady_clock::now();
      const long units = samples[i].work();
      double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (round < 0) continue;
      if (samples[i].parts) {
        seconds = 0.0;
        for (const auto& [name, part] : samples[i].parts()) {
          records[i].parts[name].push_back(part / static_cast<double>(units));
          seconds += part;
        }
      }
      records[i].samples.push_back(seconds / static_cast<double>(units));
    }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    records[i].error = cases[i].error();
    if (cases[i].facts) records[i].facts = cases[i].facts();
  }
  return records;
}

}  // namespace drogue::perf
