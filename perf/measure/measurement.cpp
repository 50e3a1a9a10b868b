#include "perf/measure/measurement.hpp"

#include <algorithm>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "common/run/statistics.hpp"
#include "perf/measure/rounds.hpp"

namespace drogue::perf {

namespace {

/// Time of successive samples of one case as one sample.
struct TimedSample {
  double seconds = 0.0;
  double wall = 0.0;  ///< s, with what is not timed
  long units = 0;
  std::map<std::string, double> parts;  ///< s
};

/// Resets, prepares the machine and works `repeats` times. If the sample has parts, their sum is its time.
TimedSample take(const Sample& sample, long repeats, const std::function<void()>& prepare) {
  TimedSample taken;
  const Stopwatch whole;
  for (long repeat = 0; repeat < repeats; ++repeat) {
    sample.reset();
    prepare();
    const Stopwatch work;
    taken.units += sample.work();
    const double wall = work.seconds();
    if (!sample.parts) {
      taken.seconds += wall;
      continue;
    }
    for (const auto& [name, part] : sample.parts()) taken.parts[name] += part, taken.seconds += part;
  }
  taken.wall = whole.seconds();
  return taken;
}

}  // namespace

double timer_overhead() {
  const Sample empty{[] {}, [] { return 1L; }};
  std::vector<double> seconds;
  for (int i = 0; i < 200; ++i) seconds.push_back(take(empty, 100, [] {}).seconds / 100.0);
  return run::median(seconds);
}

std::vector<Record> measure(const std::vector<Case>& cases, int warm_up, int rounds,
                            const Instruments& instruments) {
  const GpuClocks* const clocks = instruments.clocks;
  const bool cold = static_cast<bool>(instruments.empty_caches);
  std::vector<Record> records;
  std::vector<Sample> samples;
  for (const Case& c : cases) {
    Record& record = records.emplace_back(Record{c.name, c.unit_of_work, c.bound, c.backend});
    record.tolerance = c.tolerance;
    record.facts = c.facts;
    samples.push_back(c.prepare());
  }
  std::vector<long> repeats(cases.size(), 1);
  std::vector<double> lasted(cases.size(), 0.0);
  WarmUp warmth;
  for (int round = -warm_up; round < rounds && !interrupted(); ++round) {
    if (round == 0 && warm_up > 0 && !warmth.is_over(warm_up_seconds)) round = -1;
    for (std::size_t i = 0; i < cases.size() && !interrupted(); ++i) {
      if (lasted[i] >= instruments.longest_case && records[i].samples.size() >= least_samples) continue;
      const TimedSample taken = take(samples[i], repeats[i], [&] {
        if (cold) instruments.empty_caches(cases[i].on_device());
      });
      if (round < 0) {
        warmth.add(cases[i].on_device(), cold ? taken.wall : taken.seconds);
        const auto works = static_cast<double>(repeats[i]);
        if (!cold) repeats[i] = repeats_of(taken.seconds / works, taken.wall / works);
        continue;
      }
      if (clocks != nullptr && cases[i].on_device())
        if (auto reading = clocks->read()) records[i].clocks.push_back(std::move(*reading));
      lasted[i] += taken.wall;
      const auto units = static_cast<double>(taken.units);
      for (const auto& [name, part] : taken.parts) records[i].parts[name].push_back(part / units);
      records[i].samples.push_back(taken.seconds / units);
      records[i].repeats = repeats[i];
      records[i].units = taken.units;
    }
    if (round < 0 && clocks != nullptr)
      if (const auto reading = clocks->read()) warmth.add_clock(reading->sm_mhz);
  }
  if (interrupted() && std::ranges::any_of(records, [](const Record& r) { return r.samples.empty(); }))
    throw Failure(ExitCode::interrupted, "interrupted by a signal before every case had a sample");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    records[i].error = samples[i].error();
    if (samples[i].complete) samples[i].complete(records[i].facts);
  }
  return records;
}

}  // namespace drogue::perf
