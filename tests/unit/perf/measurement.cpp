#include "perf/measure/measurement.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

// Order and number of the works of samples. Durations are those of waits.

namespace drogue::perf {
namespace {

using std::chrono::milliseconds;

/// Case that writes its resets and works into `log`.
Case logged_case(std::string& log, bool on_device, milliseconds duration = milliseconds(0)) {
  Case made;
  made.name = "a", made.unit_of_work = "step";
  made.backend = on_device ? device::Backend::cuda : device::Backend::serial;
  made.prepare = [&log, duration] {
    return Sample{[&log] { log += "reset "; },
                  [&log, duration] {
                    log += "work ";
                    std::this_thread::sleep_for(duration);
                    return 1L;
                  },
                  [] { return 0.0; }};
  };
  made.tolerance = 0.0;
  return made;
}

long count(const std::string& log, const std::string& word) {
  long found = 0;
  for (std::size_t at = log.find(word); at != std::string::npos; at = log.find(word, at + 1)) ++found;
  return found;
}

TEST(Measurement, EmptiesCachesBetweenInitialStateAndWork) {
  std::string log;
  Instruments instruments;
  instruments.empty_caches = [&log](bool on_device) { log += on_device ? "device " : "host "; };
  measure({logged_case(log, false), logged_case(log, true)}, 0, 2, instruments);
  EXPECT_EQ(log, "reset host work reset device work reset host work reset device work ");
}

TEST(Measurement, EmptiesCachesOutsideOfTheTime) {
  std::string log;
  Instruments instruments;
  instruments.empty_caches = [](bool) { std::this_thread::sleep_for(milliseconds(50)); };
  const std::vector<Record> records = measure({logged_case(log, false)}, 0, 3, instruments);
  for (const double seconds : records.front().samples) EXPECT_LT(seconds, 0.05);
}

TEST(Measurement, WarmSamplesRepeatShortWorks) {
  std::string log;
  const std::vector<Record> records = measure({logged_case(log, false, milliseconds(1))}, 1, 2);
  EXPECT_GT(records.front().repeats, 1);
  EXPECT_EQ(records.front().units, records.front().repeats);
}

TEST(Measurement, LongCasesLeaveTheLaterRounds) {
  std::string log;
  Instruments instruments;
  const auto samples = [&](double longest_case) {
    instruments.longest_case = longest_case;
    return measure({logged_case(log, false, milliseconds(1))}, 0, 7, instruments).front().samples.size();
  };
  EXPECT_EQ(samples(1e9), 7U);
  EXPECT_EQ(samples(1e-3), least_samples) << "a wait of a millisecond lasts for no less";
}

TEST(Measurement, ColdSamplesAreSingleWorks) {
  std::string log;
  Instruments instruments;
  instruments.empty_caches = [&log](bool) {
    log += "sweep ";
    // Short, so that several works would fit into a sample.
    std::this_thread::sleep_for(milliseconds(2));
  };
  const std::vector<Record> records = measure({logged_case(log, false, milliseconds(1))}, 1, 2, instruments);
  EXPECT_EQ(records.front().repeats, 1);
  EXPECT_EQ(records.front().units, 1);
  EXPECT_EQ(count(log, "sweep"), count(log, "work"));
  // Sweeps count as work: a warm-up of a second has 333 of them, not a thousand.
  EXPECT_LT(count(log, "work"), 400);
}

}  // namespace
}  // namespace drogue::perf
