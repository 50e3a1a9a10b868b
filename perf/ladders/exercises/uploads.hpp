#pragma once

namespace drogue::perf::ladder {

/// Exercise `uploads`, from rung 2 to rung 5 of the transfer ladder: `up` copies all values to the device,
/// `compute` does a step of them there, `down` copies them back. Nobody reads the values on the host between
/// the steps.
struct UploadsExercise {
  template <class Up, class Compute, class Down>
  static void run(long steps, const Up& up, const Compute& compute, const Down& down) {
    for (long step = 0; step < steps; ++step) up(), compute(), down();
  }
};

}  // namespace drogue::perf::ladder
