#include "perf/measure/measurement.hpp"

#include <chrono>
#include <utility>

namespace drogue::perf {

namespace {

/// Does the work of a sample, and returns its units and its duration, s.
std::pair<long, double> timed(const Sample& sample) {
  sample.reset();
  const auto begin = std::chrono::steady_clock::now();
  const long units = sample.work();
  return {units, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

/// Appends a sample to a record.
void take(const Sample& sample, Record& record) {
  auto [units, seconds] = timed(sample);
  if (sample.parts) {
    seconds = 0.0;
    for (const auto& [name, part] : sample.parts()) {
      record.parts[name].push_back(part / static_cast<double>(units));
      seconds += part;
    }
  }
  record.samples.push_back(seconds / static_cast<double>(units));
}

}  // namespace

std::vector<Record> measure(const std::vector<Case>& cases, const WarmUp& discarded, int rounds) {
  std::vector<Record> records;
  std::vector<Sample> samples;
  for (const Case& c : cases) {
    records.push_back({c.name, c.unit_of_work, c.bound, {}, 0.0, c.tolerance, {}, {}});
    samples.push_back(c.prepare());
  }
  double worked = 0.0;
  for (int round = 0; round < discarded.rounds || (!cases.empty() && worked < discarded.seconds); ++round)
    for (const Sample& sample : samples) worked += timed(sample).second;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < cases.size(); ++i) take(samples[i], records[i]);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    records[i].error = cases[i].error();
    if (cases[i].facts) records[i].facts = cases[i].facts();
  }
  return records;
}

}  // namespace drogue::perf
