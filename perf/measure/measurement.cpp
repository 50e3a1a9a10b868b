#include "perf/measure/measurement.hpp"

#include <chrono>

#include "perf/measure/warm_up.hpp"

namespace drogue::perf {

std::vector<Record> measure(const std::vector<Case>& cases, int warm_up, int rounds) {
  std::vector<Record> records;
  std::vector<Sample> samples;
  for (const Case& c : cases) {
    records.push_back({c.name, c.unit_of_work, c.bound, {}, 0.0, c.tolerance, {}, {}});
    samples.push_back(c.prepare());
  }
  const auto since = [](std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  WarmUp warmth;
  for (int round = -warm_up; round < rounds; ++round) {
    if (round == 0 && warm_up > 0 && !warmth.has_reached(warm_up_seconds)) round = -1;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      samples[i].reset();
      const auto begin = std::chrono::steady_clock::now();
      const long units = samples[i].work();
      double seconds = since(begin);
      if (round < 0) {
        warmth.add(cases[i].on_device, seconds);
        continue;
      }
      if (samples[i].parts) {
        seconds = 0.0;
        for (const auto& [name, part] : samples[i].parts()) {
          records[i].parts[name].push_back(part / static_cast<double>(units));
          seconds += part;
        }
      }
      records[i].samples.push_back(seconds / static_cast<double>(units));
    }
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    records[i].error = cases[i].error();
    if (cases[i].facts) records[i].facts = cases[i].facts();
  }
  return records;
}

}  // namespace drogue::perf
