#pragma once

// Definitions of SolverOn: what it holds, and how that gets there and back.

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, ConstitutiveModel law>
SolverOn<ExecutionSpace, law>::SolverOn(const Parameters& p)
    : _instance(static_cast<int>(1 + p.mesh.rest.size() / 512)),
      _mesh(p.mesh),
      _material(p.material),
      _vertices(static_cast<int>(p.mesh.rest.size())),
      _padded((_vertices + slice - 1) / slice * slice),
      _integrator(p.integrator),
      _driver(p.driver),
      _damping(p.damping),
      _decay(_integrator == Integrator::rk4 ? p.damping : 0.0),
      _clock{0, p.dt, 0, 0.0},
      _watch{decltype(_watch.steps)("drogue::fabric::steps"), decltype(_watch.lost)("drogue::fabric::lost"),
             decltype(_watch.raised)("drogue::fabric::raised")} {
  const auto n = static_cast<std::size_t>(_vertices);
  const ExecutionSpace& space = _instance.space();
  const RingAdjacency rings =
      ring_adjacency(has_triangles(law.model) ? p.mesh : Mesh{p.mesh.rest, {}, {}, {}, {}});
  const SpringAdjacency springs = spring_adjacency(p.mesh, p.material);
  if constexpr (has_triangles(law.model)) {
    _cloth.triangles = sliced_ell_views(space, rings, device::is_host<ExecutionSpace>);
    if constexpr (!device::is_host<ExecutionSpace>) _cloth.rest = rest_places(p);
  }
  _cloth.springs = sliced_ell_views(space, springs);
  _cloth.moduli = moduli(p.material.membrane_modulus, p.material.poisson);
  _cloth.gravity = {p.gravity[0], p.gravity[1], p.gravity[2]};
  _cloth.damping = _integrator == Integrator::rk4 ? p.damping : 0.0;
  _cloth.inverse_mass =
      decltype(_cloth.inverse_mass)("drogue::fabric::inverse_mass", static_cast<std::size_t>(_padded));
  const auto inverse_mass = Kokkos::create_mirror_view(_cloth.inverse_mass);
  // Vertices that fill the last slice have no mass and no freedom: they stay.
  _cloth.held = decltype(_cloth.held)("drogue::fabric::held", static_cast<std::size_t>(_padded));
  const auto held = Kokkos::create_mirror_view(_cloth.held);
  for (std::size_t i = 0; i < held.extent(0); ++i) {
    if (i < n) inverse_mass(i) = 1.0 / p.mass[i];
    held(i) = i >= n ? 7 : p.pinned.empty() ? 0 : p.pinned[i];
  }
  for (const Motion& motion : p.motions)
    for (const int i : motion.vertices)
      held(i) |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(motion.axis));
  device::copy(_instance.space(), _cloth.inverse_mass, inverse_mass);
  device::copy(_instance.space(), _cloth.held, held);
  _instance.space().fence("drogue::fabric::vertices");
  std::vector<Vector> load = rest_pull(p.mesh, p.material);
  if (!load.empty()) {
    _pull = points("drogue::fabric::pull");
    to_device(load, _pull);
    // k (X_j - X_i)^2 / 2 of every spring.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) _rest_energy += 0.5 * load[i][axis] * p.mesh.rest[i][axis];
  }
  if (load.empty())
    load = p.load;
  else if (!p.load.empty())
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) load[i][axis] += p.load[i][axis];
  if (std::ranges::any_of(load, [](const Vector& v) { return v != Vector{}; })) {
    _dead = points("drogue::fabric::dead_load");
    to_device(load, _dead);
  }
  _cloth.load = _dead;
  prepare_external(p);
  prepare_motions(p);
  if (_external.pressure.extent(0) > 0 || _external.bending.first.extent(0) > 0)
    _load_stiffness = decltype(_load_stiffness)("drogue::fabric::load_stiffness", n);
  make_sums();
  _x = points("drogue::fabric::positions");
  _v = points("drogue::fabric::velocities");
  _next = points("drogue::fabric::next");
  _kept_x = points("drogue::fabric::kept_positions");
  _kept_v = points("drogue::fabric::kept_velocities");
  _kept_step = decltype(_kept_step)("drogue::fabric::kept_step");
  set_steps();
  if (p.contact.asked_for())
    _contact = make_contact<ExecutionSpace>(p, {_instance, _cloth.inverse_mass, _cloth.held, _watch});
  if (_integrator != Integrator::rk4) return;
  for (int stage = 0; stage < (goes_by_stages() ? 3 : 2); ++stage)
    _velocity[stage] = points("drogue::fabric::stage_velocities");
  _other = points("drogue::fabric::stage_positions");
  make_persistent(p, rings, springs);
  record();
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::upload(std::span<const Vector> positions,
                                           std::span<const Vector> velocities) {
  const auto within = [](const Vector& vector) {
    return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]) < lost_beyond;
  };
  if (!std::ranges::all_of(positions, within) || !std::ranges::all_of(velocities, within))
    throw std::invalid_argument("fabric solver: positions and velocities must be finite");
  to_device(positions, _x);
  to_device(velocities, _v);
  _failure.reset();
  set_steps();
  if (_contact) _contact->forget();
  keep();
  if (!_prescribed) return;
  place(_x, _v, 0.0, true);
  keep();
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::download(std::span<Vector> positions, std::span<Vector> velocities) {
  settle();
  to_host(_x, positions);
  to_host(_v, velocities);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::require_one_a_vertex(std::size_t count) const {
  if (count != static_cast<std::size_t>(_vertices))
    throw std::invalid_argument("fabric solver: there must be one vector a vertex");
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::to_device(std::span<const Vector> from, const Points& to) const {
  require_one_a_vertex(from.size());
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < mirror.extent(0); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = i < from.size() ? from[i][axis] : 0.0;
  device::copy(_instance.space(), to, mirror);
  _instance.space().fence("drogue::fabric::to_device");
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::to_host(const Points& from, std::span<Vector> to) const {
  require_one_a_vertex(to.size());
  typename Points::HostMirror mirror = _on_host;
  if constexpr (device::is_host<ExecutionSpace>)
    mirror = from;
  else if (mirror.extent(0) == 0)
    mirror = _on_host = Kokkos::create_mirror(from);
  device::copy(_instance.space(), mirror, from);
  _instance.space().fence("drogue::fabric::to_host");
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) to[i][axis] = mirror(i, axis);
}

}  // namespace drogue::fabric
