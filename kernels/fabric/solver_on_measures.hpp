#pragma once

// Definitions of SolverOn: what it tells of the state where it is.

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/fabric/elastic/lanczos.hpp"
#include "kernels/fabric/solver_on.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::forces(std::span<Vector> forces) {
  settle();
  forces_at(_x, forces);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::forces_at(const Points& x, std::span<Vector> forces) const {
  if (_acts) act(x, _v, 0.0, false);
  launch("drogue::fabric::force", ForceFunctor<ExecutionSpace, law>{_cloth, x, _next});
  to_host(_next, forces);
}

template <class ExecutionSpace, ConstitutiveModel law>
template <ConstitutiveModel of>
double SolverOn<ExecutionSpace, law>::largest_row(const ListView<ExecutionSpace, double>& more) const {
  double largest = 0.0;
  Kokkos::parallel_reduce(
      "drogue::fabric::frequency", Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0, _vertices),
      FrequencyFunctor<ExecutionSpace, of>{_cloth, _x, more}, Kokkos::Max<double>(largest));
  return largest;
}

template <class ExecutionSpace, ConstitutiveModel law>
double SolverOn<ExecutionSpace, law>::fastest_frequency() {
  settle();
  const ListView<ExecutionSpace, double>& more = _load_stiffness;
  if (more.extent(0) > 0)
    launch_each("drogue::fabric::load_stiffness", _vertices,
                LoadStiffnessFunctor<ExecutionSpace>{loads_at(_x, _v, 0.0, false), more});
  double row = largest_row<law>(more);
  // What is slack now may be taut before it is asked again.
  if constexpr (law.tension_only) row = std::max(row, largest_row<ConstitutiveModel{law.model}>(more));
  return std::sqrt(row);
}

template <class ExecutionSpace, ConstitutiveModel law>
double SolverOn<ExecutionSpace, law>::frequency_at_least() {
  settle();
  const auto n = static_cast<std::size_t>(_vertices);
  // M^-1/2 K M^-1/2 is symmetric; what is held has no row in it.
  const auto inverse_mass = Kokkos::create_mirror_view(_cloth.inverse_mass);
  const auto held = Kokkos::create_mirror_view(_cloth.held);
  device::copy(_instance.space(), inverse_mass, _cloth.inverse_mass);
  device::copy(_instance.space(), held, _cloth.held);
  _instance.space().fence("drogue::fabric::masses");
  std::vector<double> root(3 * n);
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = (held(k / 3) >> k % 3 & 1U) != 0U ? 0.0 : std::sqrt(inverse_mass(k / 3));
  // Short enough that forces are linear, long enough that they are more than round-off.
  const double way = 1e-5 * shortest_edge(_mesh);
  std::vector<Vector> now(n), v(n), ahead(n), behind(n);
  download(now, v);
  const Points trial = points("drogue::fabric::trial");
  const auto force_after = [&](double factor, std::span<const double> move, std::vector<Vector>& force) {
    for (std::size_t k = 0; k < root.size(); ++k)
      force[k / 3][k % 3] = now[k / 3][k % 3] + factor * root[k] * move[k];
    to_device(force, trial);
    forces_at(trial, force);
  };
  const auto apply = [&](std::span<const double> in, std::span<double> out) {
    double most = 0.0;
    for (std::size_t k = 0; k < root.size(); ++k) most = std::max(most, std::abs(root[k] * in[k]));
    const double factor = most > 0.0 ? way / most : 0.0;
    force_after(factor, in, ahead);
    force_after(-factor, in, behind);
    for (std::size_t k = 0; k < root.size(); ++k)
      out[k] = most > 0.0 ? root[k] * (behind[k / 3][k % 3] - ahead[k / 3][k % 3]) / (2.0 * factor) : 0.0;
  };
  return std::sqrt(std::max(0.0, largest_ritz_value(root.size(), 64, apply)));
}

/// Totals are asked for again and again: what sums need is made once.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::make_sums() {
  int rows = _vertices;
  do {
    rows = (rows + sum_radix - 1) / sum_radix;
    _sums.emplace_back("drogue::fabric::totals", static_cast<std::size_t>(rows));
  } while (rows > 1);
  _sum = Kokkos::create_mirror_view(_sums.back());
}

template <class ExecutionSpace, ConstitutiveModel law>
Totals SolverOn<ExecutionSpace, law>::totals() {
  settle();
  const ExecutionSpace& space = _instance.space();
  Cloth<ExecutionSpace> dead_alone = _cloth;
  dead_alone.load = _dead;
  Kokkos::parallel_for("drogue::fabric::totals",
                       Kokkos::RangePolicy<ExecutionSpace>(space, 0, _sums.front().extent(0)),
                       TotalsFunctor<ExecutionSpace, law>{dead_alone, _x, _v, _pull, _external.bending,
                                                          _sums.front(), _vertices});
  for (std::size_t level = 1; level < _sums.size(); ++level)
    Kokkos::parallel_for("drogue::fabric::sum",
                         Kokkos::RangePolicy<ExecutionSpace>(space, 0, _sums[level].extent(0)),
                         SumFunctor<ExecutionSpace>{_sums[level - 1], _sums[level]});
  const auto& mirror = _sum;
  device::copy(space, mirror, _sums.back());
  space.fence("drogue::fabric::totals");
  Totals t{mirror(0, 0), mirror(0, 1) + _rest_energy, mirror(0, 2), mirror(0, 3), {}, {}, 0.0, 0.0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    t.momentum[axis] = mirror(0, 4 + axis), t.angular_momentum[axis] = mirror(0, 7 + axis);
  if (!_contact) return t;
  std::vector<ContactWork> work(static_cast<std::size_t>(_vertices));
  _contact->work(work);
  for (const ContactWork& of_vertex : work) t.contact += of_vertex.normal, t.friction += of_vertex.friction;
  return t;
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::contact_work(std::span<ContactWork> of_vertices) {
  settle();
  require_one_a_vertex(of_vertices.size());
  std::ranges::fill(of_vertices, ContactWork{});
  if (_contact) _contact->work(of_vertices);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::set_contact_work(std::span<const ContactWork> of_vertices) {
  settle();
  require_one_a_vertex(of_vertices.size());
  if (_contact) _contact->set_work(of_vertices);
}

}  // namespace drogue::fabric
