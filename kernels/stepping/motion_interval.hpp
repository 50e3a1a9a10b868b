#pragma once

namespace drogue::stepping {

/// Part of a run in which prescribed motion is almost a linear function of time. It ends where the next one
/// begins; the last one has no end.
struct MotionInterval {
  double begin;     ///< s
  double longest;   ///< s, dt that resolves the motion
  double rate;      ///< 1/s, largest speed over cell widths
  int begins_with;  ///< 1 if the motion jumps at the beginning, or begins after rest: a step should end there
};

}  // namespace drogue::stepping
