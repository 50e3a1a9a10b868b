#pragma once

#include <vector>

#include "kernels/fabric/body.hpp"

namespace drogue::fabric {

/// Contact of cloth with bodies and with itself.
struct Contact {
  std::vector<Body> bodies;
  bool self = false;         ///< contact of cloth and strings with themselves
  double thickness = 0.002;  ///< m, distance between layers in contact, and from bodies
  double friction = 0.0;     ///< Coulomb coefficient between layers
  /// Steps between resolutions of contact, >= 1. From 2 on, contact is resolved after the steps of an
  /// interval, from the displacements in it (Bridson, Fedkiw and Anderson 2002); the end of a call of
  /// `enqueue_steps` ends an interval. With 1, impulses precede every step.
  int interval = 1;
  /// Threads of a team that resolves an interval in one launch of a device, a multiple of 32 up to 512; 0:
  /// 512.
  int block = 0;

  /// True if there is contact with bodies or itself. Does not throw.
  [[nodiscard]] bool is_enabled() const { return self || !bodies.empty(); }
};

}  // namespace drogue::fabric
