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
      : _along{SpaceTimeFunction(body.motion[0]), SpaceTimeFunction(body.motion[1]),
               SpaceTimeFunction(body.motion[2])},
        _moves(body.moves()) {}

  [[nodiscard]] bool moves() const { return _moves; }
  /// Displacement at a time, s, in m.
  [[nodiscard]] mesh::Vector at(double time) const {
    return {_along[0]({}, time), _along[1]({}, time), _along[2]({}, time)};
  }

 private:
  std::array<SpaceTimeFunction, 3> _along;
  bool _moves;
};

}  // namespace drogue::parachute_app
