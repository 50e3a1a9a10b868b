#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace drogue::perf {

/// The two halves of a sample.
struct Sample {
  std::function<void()> reset;  ///< brings back the initial state; not timed
  std::function<long()> work;   ///< returns the units of work done
  /// Seconds of the named parts of the last work. Where there are such, their sum is its time, and not the
  /// wall's.
  std::function<std::map<std::string, double>()> parts = {};
};

/// What a roofline needs to know of a case. Zero or empty: not known, or not asked.
struct Facts {
  std::string backend;
  std::int64_t cells = 0;
  std::string variant;  ///< what differs from the usual case of this backend and size
  double flops = 0.0;   ///< a unit of work
  double bytes = 0.0;   ///< a unit of work, between kernels and memory
};

/// One thing that can be timed.
struct Case {
  std::string name;          ///< work/variant/size, as `drogue-perf list` prints it
  std::string unit_of_work;  ///< what a sample's seconds are divided by: "step"
  std::string bound;         ///< what limits it, in words
  std::function<Sample()> prepare;
  /// Error of the state it ends in, against the oracle or an exact solution; called after the last sample.
  std::function<double()> error;
  double tolerance;                   ///< largest error with which the timing counts
  std::function<Facts()> facts = {};  ///< called after the last sample, where there is one
};

// Those that this build and machine can run.
std::vector<Case> gas_cases(bool quick);
std::vector<Case> fabric_cases(bool quick);
std::vector<Case> contact_cases(bool quick);
std::vector<Case> options_cases(bool quick);
std::vector<Case> tridiagonal_cases(bool quick);
std::vector<Case> ceiling_cases();
std::vector<Case> all_cases(bool quick);

struct Record {
  std::string name, unit_of_work, bound;
  std::vector<double> samples;  ///< seconds per unit of work
  double error = 0.0;
  double tolerance = 0.0;
  std::map<std::string, std::vector<double>> parts;  ///< of `samples`, where a case names any
  Facts facts;

  [[nodiscard]] bool passed() const { return error <= tolerance; }
};

/// Rounds that are not kept, and those that are.
inline constexpr int warm_up_rounds = 3;
constexpr int kept_rounds(bool quick) { return quick ? 7 : 25; }

/// Times `cases` in turns, one sample each a round, so that a disturbance meets all of them; the first rounds
/// are not kept.
std::vector<Record> measure(const std::vector<Case>& cases, int warm_up, int rounds);

}  // namespace drogue::perf
