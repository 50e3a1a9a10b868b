#pragma once

#include "kernels/fabric/external.hpp"

namespace drogue::fabric {

/// Axes of vertices that are held where an expression says.
template <class ExecutionSpace>
struct Prescribed {
  PointsView<ExecutionSpace> rest;
  ProgramsView<ExecutionSpace> displacement;
  ListView<ExecutionSpace, int> vertex, axis, program;
};

/// Puts them there, and gives them the velocity of their motion from differences of fourth order over a step;
/// within the first step of second order and ahead, for an expression need not know a time before 0.
template <class ExecutionSpace>
struct PlaceFunctor {
  Prescribed<ExecutionSpace> prescribed;
  PointsView<ExecutionSpace> x, v;
  Timing<ExecutionSpace> timing;
  bool looks;  ///< at what it leaves, for this ends a step

  KOKKOS_FUNCTION void operator()(const int k) const {
    const int i = prescribed.vertex(k), axis = prescribed.axis(k);
    const Vector3<double> place = load_points<double>(prescribed.rest, i);
    const auto moved = [&](double t) {
      return device::evaluate(prescribed.displacement(prescribed.program(k)), place.x, place.y, place.z, t);
    };
    const double t = timing.time(), dt = timing.clock.dt, half = 0.5 * dt, now = moved(t);
    const double position = prescribed.rest(i, axis) + now;
    const double velocity =
        t < dt ? (4.0 * moved(t + half) - 3.0 * now - moved(t + dt)) / dt
               : (8.0 * (moved(t + half) - moved(t - half)) - (moved(t + dt) - moved(t - dt))) / (6.0 * dt);
    x(i, axis) = position;
    v(i, axis) = velocity;
    if (looks && !(Kokkos::fabs(position) + Kokkos::fabs(velocity) < lost_beyond))
      timing.watch.raise(timing.watch.steps(timing.hand), i);
  }
};

}  // namespace drogue::fabric
