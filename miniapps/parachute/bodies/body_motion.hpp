#pragma once

#include "kernels/mesh/mesh.hpp"
#include "miniapps/parachute/bodies/body.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {

/// Prescribed displacement of a body. Throws std::invalid_argument for an invalid expression.
class BodyMotion {
 public:
  explicit BodyMotion(const Body& body) : _displacement(body.motion), _moves(body.moves()) {}

  [[nodiscard]] bool moves() const { return _moves; }
  /// Displacement at a time, s, in m.
  [[nodiscard]] mesh::Vector at(double time) const { return _displacement({}, time); }

 private:
  SpaceTimeVector _displacement;
  bool _moves;
};

}  // namespace drogue::parachute_app
