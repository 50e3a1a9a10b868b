#pragma once

#include <array>
#include <cstddef>

#include "kernels/mesh/mesh.hpp"
#include "miniapps/parachute/bodies/body.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {

/// Prescribed displacement of a body. Throws std::invalid_argument for an invalid expression.
class BodyMotion {
 public:
  explicit BodyMotion(const Body& body)
      : _along{function(body, 0), function(body, 1), function(body, 2)}, _moves(body.moves()) {}

  [[nodiscard]] bool moves() const { return _moves; }
  /// Displacement at a time, s, in m.
  [[nodiscard]] mesh::Vector at(double time) const {
    return {_along[0]({}, time), _along[1]({}, time), _along[2]({}, time)};
  }

 private:
  static SpaceTimeFunction function(const Body& body, std::size_t axis) {
    return SpaceTimeFunction(body.motion[axis].empty() ? "0" : body.motion[axis]);
  }

  std::array<SpaceTimeFunction, 3> _along;
  bool _moves;
};

}  // namespace drogue::parachute_app
