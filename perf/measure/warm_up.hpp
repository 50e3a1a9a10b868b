#pragma once

namespace drogue::perf {

/// Stopping rule of a warm-up. Work on host cores does not raise the clock of a GPU, so the seconds of cases
/// on a device and of the others are counted apart.
class WarmUp {
 public:
  /// Counts seconds of work on a device or on cores of the host. Does not throw.
  void add(bool on_device, double seconds) {
    Kind& kind = on_device ? _device : _host;
    kind.present = true;
    kind.seconds += seconds;
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
};

}  // namespace drogue::perf
