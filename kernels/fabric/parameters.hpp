#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "kernels/mesh/mesh.hpp"
#include "kernels/stepping/driver.hpp"

namespace drogue::fabric {

/// Constitutive model of cloth.
enum class Model {
  linear_vector,  ///< Model I: springs of vectors; not invariant under rotation, for linear analysis alone
  edge,           ///< Model II: springs of lengths along the edges
  quadratic,      ///< Delingette 2008: tensile and angular springs, energy quadratic in the lengths
  biquadratic,    ///< Delingette 2008: quadratic in the squared lengths; equals St Venant-Kirchhoff
};

/// True if triangles resist as a whole; in the other models their edges resist. Does not throw.
[[nodiscard]] constexpr bool has_triangles(Model model) {
  return model == Model::quadratic || model == Model::biquadratic;
}

enum class Integrator { rk4, verlet };

/// Driver of Runge-Kutta steps; Verlet steps are always `plain`. The persistent driver does not support
/// dashpots, bending, prescribed motions and contact.
using stepping::Driver;

/// Material of cloth and strings. `membrane_modulus` is Young's modulus times thickness.
struct Material {
  Model model = Model::biquadratic;
  double membrane_modulus = 1000.0;  ///< N/m; quadratic and biquadratic
  double poisson = 0.3;              ///< -1 .. 1/2, quadratic and biquadratic
  double stiffness = 1000.0;         ///< N/m an edge; linear_vector and edge
  double axial_stiffness = 0.0;      ///< E A of strings, N
  double bending_stiffness = 0.0;    ///< N m, across edges of two triangles; for cloth that is flat at rest
  /// Wrinkles at no cost in place of compression: the relaxed energy of triangles, and lines and edges
  /// without compressive tension. Not for linear_vector.
  bool tension_only = false;
};

using mesh::Mesh;
using mesh::Vector;

/// A force that changes: strength times direction, N. The strength is an expression of the place at rest, m,
/// and of time, s.
struct TimedLoad {
  device::ExpressionProgram strength;
  std::vector<Vector> direction;  ///< of every vertex
};

/// A pressure across cloth where it is now: each triangle gives a third of its area, times what the vertex
/// feels, to each of its vertices. Positive along the normals, about which triangles turn counterclockwise.
struct FollowerPressure {
  device::ExpressionProgram strength;  ///< Pa, of the place at rest and of time
  std::vector<double> weight;          ///< of every vertex; empty: 1
};

/// Prescribed displacement of one axis of some vertices from rest.
struct Motion {
  int axis = 0;  ///< 0 x, 1 y, 2 z
  std::vector<int> vertices;
  device::ExpressionProgram displacement;  ///< m, of the place at rest and of time
};

enum class BodyKind {
  disk,       ///< a plate without thickness, about `centre`, across `normal`
  sphere,     ///< about `centre`
  plane,      ///< all that lies behind the plane through `centre` with the outward `normal`
  level_set,  ///< where an expression of x, y, z is negative
};

/// A body at rest, which cloth cannot enter.
struct Body {
  BodyKind kind = BodyKind::sphere;
  Vector centre{};                      ///< m
  Vector normal{0.0, 0.0, 1.0};         ///< of unit length
  double radius = 0.0;                  ///< m
  device::ExpressionProgram level_set;  ///< m
  double friction = 0.0;                ///< Coulomb's coefficient between cloth and body
};

/// Contact of cloth with bodies and with itself.
struct Contact {
  std::vector<Body> bodies;
  bool self = false;         ///< cloth and strings meet themselves
  double thickness = 0.002;  ///< m, the distance that contact keeps, between layers and from bodies
  double friction = 0.0;     ///< between layers

  [[nodiscard]] bool asked_for() const { return self || !bodies.empty(); }
};

/// Parameters of a fabric solver, without the initial state.
struct Parameters {
  Mesh mesh;
  Material material;
  std::vector<double> mass;  ///< of every vertex, kg, > 0
  std::vector<std::uint8_t>
      pinned;  ///< of every vertex: 1 keeps x, 2 keeps y, 4 keeps z at its velocity; may be empty
  std::vector<Vector> load;  ///< dead force on every vertex, N; may be empty
  Vector gravity{};          ///< m/s^2
  std::vector<TimedLoad> timed_loads;
  std::vector<FollowerPressure> follower_pressures;
  std::vector<Motion> motions;  ///< they pin what they move
  double damping = 0.0;         ///< acceleration -damping times velocity, 1/s
  /// Rate at which two vertices of an edge, were they alone, would lose what their velocities differ along
  /// it, 1/s. It keeps momentum and angular momentum.
  double relative_damping = 0.0;
  Contact contact;
  Integrator integrator = Integrator::rk4;
  double dt = 0.0;  ///< s, > 0
  Driver driver = Driver::automatic;
  int patch = 0;  ///< vertices a team of the persistent driver has at least; 0: as few as fill the device
};

}  // namespace drogue::fabric
