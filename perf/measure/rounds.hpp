#pragma once

#include <algorithm>
#include <cmath>

namespace drogue::perf {

/// Shorter works are repeated within a sample, s: a sample that a switch to another process can double is
/// useless.
inline constexpr double shortest_sample = 5e-3;
/// Longest sample of repeated works, s, with what is not timed, such as the copies of the scheme of [Shi].
inline constexpr double longest_repeated_sample = 25e-3;

/// Works of a sample that fill `shortest_sample`, 200 at most, from the timed seconds of one; fewer, but one,
/// if the sample would last longer than `longest_repeated_sample`, from the seconds of one with what is not
/// timed. Does not throw.
[[nodiscard]] inline long repeats_of(double timed, double whole) {
  const double wanted = std::ceil(shortest_sample / std::max(timed, 1e-9));
  const double affordable = std::floor(longest_repeated_sample / std::max(whole, 1e-9));
  return static_cast<long>(std::clamp(std::min(wanted, affordable), 1.0, 200.0));
}

/// Stopping rule of a warm-up: some time of work, and more while the clock of a GPU rises. Work on host cores
/// does not raise that clock, so the seconds of cases on a device and of the others are counted apart.
class WarmUp {
 public:
  /// Counts seconds of work on a device or on cores of the host. Does not throw.
  void add(bool on_device, double seconds) {
    Kind& kind = on_device ? _device : _host;
    kind.present = true;
    kind.seconds += seconds;
  }

  /// Notes the clock of a GPU after a round. Does not throw.
  void add_clock(unsigned mhz) {
    _clock_before = _clock == 0 ? mhz : _clock;
    _clock = mhz;
  }

  /// True after `seconds` of work unless the clock rose in the last round, and after twice the time in any
  /// case. Does not throw.
  [[nodiscard]] bool is_over(double seconds) const {
    constexpr double rise = 1.02;
    const bool rises = _clock > rise * _clock_before;
    return has_reached(rises ? 2.0 * seconds : seconds);
  }

  /// True if each kind of case that was counted has worked for that long, s. Does not throw.
  [[nodiscard]] bool has_reached(double seconds) const {
    return _device.has_reached(seconds) && _host.has_reached(seconds);
  }

 private:
  struct Kind {
    bool present = false;
    double seconds = 0.0;
    [[nodiscard]] bool has_reached(double wanted) const { return !present || seconds >= wanted; }
  };

  Kind _device, _host;
  unsigned _clock_before = 0, _clock = 0;  ///< MHz; 0: unknown
};

}  // namespace drogue::perf
