#pragma once

namespace drogue::perf {

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
