#pragma once

#include "kernels/device/expression_program.hpp"
#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Shapes of bodies.
enum class BodyKind {
  disk,       ///< plate without thickness about `centre`, perpendicular to `normal`
  sphere,     ///< about `centre`
  plane,      ///< half-space behind the plane through `centre` with the outward `normal`
  level_set,  ///< region where an expression of x, y, z is negative
};

/// Rigid body at rest, which cloth cannot enter.
struct Body {
  BodyKind kind = BodyKind::sphere;
  Vector centre{};                      ///< m
  Vector normal{0.0, 0.0, 1.0};         ///< of unit length
  double radius = 0.0;                  ///< m
  device::ExpressionProgram level_set;  ///< m
  double friction = 0.0;                ///< Coulomb coefficient between cloth and body
};

}  // namespace drogue::fabric
