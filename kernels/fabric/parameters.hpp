#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "kernels/fabric/contact/contact_parameters.hpp"
#include "kernels/fabric/integrator.hpp"
#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Time-dependent force: strength times direction, N. The strength is an expression of the position at rest,
/// m, and time, s.
struct TimedLoad {
  device::ExpressionProgram strength;
  std::vector<Vector> direction;  ///< one per vertex
};

/// Follower pressure: each triangle contributes a third of its present area vector times the pressure at the
/// vertex to each of its vertices. Positive along the normals, about which triangles turn counterclockwise.
struct FollowerPressure {
  device::ExpressionProgram strength;  ///< Pa, of the position at rest and time
  std::vector<double> weight;          ///< one per vertex; empty: 1
};

/// Prescribed displacement of one axis of some vertices from rest.
struct Motion {
  int axis = 0;  ///< 0 x, 1 y, 2 z
  std::vector<int> vertices;
  device::ExpressionProgram displacement;  ///< m, of the position at rest and time
};

/// Parameters of a fabric solver, without the initial state.
struct Parameters {
  Mesh mesh;
  Material material;
  std::vector<double> mass;          ///< one per vertex, kg, > 0
  std::vector<std::uint8_t> pinned;  ///< one per vertex: sum of 1 for x, 2 for y, 4 for z, which move at
                                     ///< their velocity; may be empty
  std::vector<Vector> load;          ///< dead forces, one per vertex, N; may be empty
  Vector gravity{};                  ///< m/s^2
  std::vector<TimedLoad> timed_loads;
  std::vector<FollowerPressure> follower_pressures;
  std::vector<Motion> motions;  ///< they also pin their axes
  double damping = 0.0;         ///< acceleration -damping times velocity, 1/s
  /// Decay rate of the relative velocity of the two vertices of an isolated edge along it, 1/s. Conserves
  /// momentum and angular momentum.
  double relative_damping = 0.0;
  Contact contact;
  Integrator integrator = Integrator::rk4;
  double dt = 0.0;  ///< s, > 0
  Driver driver = Driver::automatic;
  int patch = 0;  ///< minimum of vertices per team of the persistent driver; 0: all teams of the device
};

}  // namespace drogue::fabric
