#include "miniapps/springs/simulation/problem.hpp"

#include <cmath>
#include <numeric>

#include "kernels/mesh/renumbering.hpp"
#include "kernels/mesh/topology.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/verify/probe.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;

std::vector<double> masses_of(const SpringsScene& scene, Problem& problem) {
  const Fabric& f = scene.fabric;
  std::vector<double> mass = fabric::lumped_masses(scene.mesh, f.area_density, f.line_density, f.mass);
  for (const Payload& payload : scene.payloads)
    for (const int i : selected(payload.where, scene.mesh)) {
      mass[static_cast<std::size_t>(i)] += payload.add;
      problem.payload += payload.add;
    }
  problem.mass = std::accumulate(mass.begin(), mass.end(), 0.0);
  return mass;
}

/// Nodal forces of a unit pressure at rest, m^2: a third of the area of every triangle along its normal at
/// each of its vertices.
std::vector<Vector> area_vectors(const fabric::Mesh& mesh) {
  std::vector<Vector> sum(mesh.rest.size(), Vector{});
  for (const auto& triangle : mesh.triangles) {
    const Vector twice = mesh::doubled_area(mesh.rest, triangle);
    for (const int i : triangle)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[static_cast<std::size_t>(i)][axis] += twice[axis] / 6.0;
  }
  return sum;
}

/// Unit vectors along an axis at the vertices where `where` holds.
std::vector<Vector> unit_forces(const fabric::Mesh& mesh, const std::string& where, std::size_t axis) {
  std::vector<Vector> units(mesh.rest.size(), Vector{});
  for (const int i : selected(where, mesh)) units[static_cast<std::size_t>(i)][axis] = 1.0;
  return units;
}

/// Force along given directions with the magnitude of an expression: a dead load if the expression does not
/// depend on the time.
void add_force(const SpringsScene& scene, const std::string& strength, const std::vector<Vector>& direction,
               Problem& problem) {
  fabric::Parameters& p = problem.parameters;
  if (depends_on_time(strength)) {
    p.timed_loads.push_back({device_program(strength), problem.to_solver(direction)});
    return;
  }
  const std::vector<double> values = values_at(strength, scene.mesh);
  for (std::size_t k = 0; k < p.load.size(); ++k) {
    const auto i = static_cast<std::size_t>(problem.order[k]);
    for (std::size_t axis = 0; axis < 3; ++axis) p.load[k][axis] += values[i] * direction[i][axis];
  }
}

void add_loads(const SpringsScene& scene, Problem& problem) {
  fabric::Parameters& p = problem.parameters;
  p.load.assign(scene.mesh.rest.size(), Vector{});
  for (const Load& load : scene.loads) {
    for (std::size_t axis = 0; axis < load.gravity.size(); ++axis) p.gravity[axis] += load.gravity[axis];
    if (!load.pressure.empty()) add_force(scene, load.pressure, area_vectors(scene.mesh), problem);
    if (!load.follower_pressure.empty())
      p.follower_pressures.push_back({device_program(load.follower_pressure), {}});
    if (!load.force) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const std::string& strength = load.force->of(axis); !strength.empty())
        add_force(scene, strength, unit_forces(scene.mesh, load.where, axis), problem);
  }
}

void add_motions(const SpringsScene& scene, Problem& problem) {
  if (scene.time.end_time == 0.0) return;  // `place_vertices` has put them there
  std::vector<int> place(problem.order.size());
  for (std::size_t k = 0; k < place.size(); ++k)
    place[static_cast<std::size_t>(problem.order[k])] = static_cast<int>(k);
  for (const Pin& pin : scene.pins)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A fixed position needs no motion: the vertex starts there.
      if (!depends_on_time(pin.motion.of(axis))) continue;
      std::vector<int> vertices = selected(pin.where, scene.mesh);
      for (int& i : vertices) i = place[static_cast<std::size_t>(i)];
      problem.parameters.motions.push_back(
          {static_cast<int>(axis), vertices, device_program(pin.motion.of(axis))});
    }
}

/// Initial positions and velocities, and the prescribed axes.
std::vector<std::uint8_t> place_vertices(const SpringsScene& scene, Problem& problem) {
  const std::size_t n = scene.mesh.rest.size();
  problem.x = values_at(scene.initial.displacement, scene.mesh);
  problem.v = values_at(scene.initial.velocity, scene.mesh);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      problem.x[i][axis] += (1.0 + scene.initial.prestretch) * scene.mesh.rest[i][axis];
  std::vector<std::uint8_t> pinned(n, 0);
  for (const Pin& pin : scene.pins) {
    const std::vector<Vector> motion = values_at(pin.motion, scene.mesh);
    for (const int vertex : selected(pin.where, scene.mesh)) {
      const auto i = static_cast<std::size_t>(vertex);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (pin.axes.find("xyz"[axis]) == std::string::npos) continue;
        pinned[i] |= static_cast<std::uint8_t>(1U << axis);
        problem.v[i][axis] = 0.0;
        if (!pin.motion.of(axis).empty()) problem.x[i][axis] = scene.mesh.rest[i][axis] + motion[i][axis];
      }
    }
  }
  return pinned;
}

template <class T>
std::vector<T> permuted(std::span<const T> values, const std::vector<int>& order) {
  std::vector<T> result;
  result.reserve(values.size());
  for (const int i : order) result.push_back(values[static_cast<std::size_t>(i)]);
  return result;
}

template <class T>
std::vector<T> returned(std::span<const T> values, const std::vector<int>& order) {
  std::vector<T> result(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) result[static_cast<std::size_t>(order[k])] = values[k];
  return result;
}

void add_contact(const SpringsContact& contact, fabric::Contact& to) {
  to.self = contact.self;
  to.thickness = contact.thickness;
  to.friction = contact.friction;
  for (const ContactObject& object : contact.objects) {
    to.bodies.push_back(object.body());
    if (!object.expression.empty()) to.bodies.back().level_set = device_program(object.expression);
  }
}

}  // namespace

fabric::Body ContactObject::body() const {
  fabric::Body body;
  body.kind = kind, body.centre = centre, body.radius = radius, body.friction = friction;
  const double size = std::hypot(normal[0], normal[1], normal[2]);
  for (std::size_t axis = 0; axis < 3; ++axis) body.normal[axis] = normal[axis] / size;
  return body;
}

std::vector<Vector> Problem::to_solver(std::span<const Vector> values) const {
  return permuted(values, order);
}

std::vector<Vector> Problem::to_scene(std::span<const Vector> values) const {
  return returned(values, order);
}

std::vector<double> Problem::to_solver(std::span<const double> values) const {
  std::vector<double> result(values.size());
  const std::size_t columns = values.size() / order.size();
  for (std::size_t k = 0; k < values.size(); ++k)
    result[k] = values[columns * static_cast<std::size_t>(order[k / columns]) + k % columns];
  return result;
}

std::vector<double> Problem::to_scene(std::span<const double> values) const {
  std::vector<double> result(values.size());
  const std::size_t columns = values.size() / order.size();
  for (std::size_t k = 0; k < values.size(); ++k)
    result[columns * static_cast<std::size_t>(order[k / columns]) + k % columns] = values[k];
  return result;
}

std::vector<fabric::Stress> Problem::to_scene(std::span<const fabric::Stress> values) const {
  return returned(values, order);
}

Problem make_problem(const SpringsScene& scene) {
  Problem problem;
  problem.order = reverse_cuthill_mckee(scene.mesh);
  fabric::Parameters& p = problem.parameters;
  p.mesh = renumber(scene.mesh, problem.order);
  p.material = scene.fabric.material;
  p.mass = permuted<double>(masses_of(scene, problem), problem.order);
  p.pinned = permuted<std::uint8_t>(place_vertices(scene, problem), problem.order);
  add_loads(scene, problem);
  add_motions(scene, problem);
  add_contact(scene.contact, p.contact);
  p.damping = scene.damping.absolute;
  p.relative_damping = scene.damping.relative;
  p.integrator = scene.time.integrator;
  // Provisional step until one is planned: pins take their velocity from it, and motions end with the scene.
  p.dt = scene.time.dt.value_or(scene.time.end_time > 0.0 ? 1e-6 * scene.time.end_time : 1.0);
  p.driver = scene.driver;
  for (const Probe& probe : scene.output.probes) problem.probes.push_back(nearest_vertex(p.mesh, probe.at));
  return problem;
}

}  // namespace drogue::springs_app
