#pragma once

#include "kernels/flow/parameters.hpp"
#include "miniapps/parachute/bodies/body_motion.hpp"

namespace drogue::parachute_app {

/// Fluid inside a closed impermeable body in prescribed motion, which moves with it. Its inertia is a part of
/// the force of the fluid on the body; without it, the force is that of the fluid outside, as on a solid
/// body. Not thread-safe.
class InsideFluid {
 public:
  /// For a body in a domain. Throws std::invalid_argument for an invalid expression.
  InsideFluid(const Body& body, const flow::Parameters& p);

  /// True unless the body is at rest, open, or lets the fluid through. Does not throw.
  [[nodiscard]] bool moves() const { return _mass > 0.0; }

  /// Mass times its mean acceleration in the step of dt, s, that ended at a time, s, in N; zero before the
  /// first step. From differences of the displacement, of second order in dt. Does not throw.
  [[nodiscard]] fabric::Vector inertia(double time, double dt);

 private:
  double _mass = 0.0;  ///< kg
  BodyMotion _motion;
};

/// Volume of the fluid inside a body without its retraction, m^3; 0 of an open one. A tube that spans a
/// periodic axis, or that of one cell, is closed. Throws only std::bad_alloc.
[[nodiscard]] double inside_volume(const Body& body, const flow::Parameters& p);

}  // namespace drogue::parachute_app
