#pragma once

// Definitions of SolverOn: what it tells of the state where it is.

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, Law law>
void SolverOn<ExecutionSpace, law>::forces(std::span<Vector> forces) {
  settle();
  if (_acts) act(_x, _v, 0.0, false);
  launch("drogue::fabric::force", ForceFunctor<ExecutionSpace, law>{_cloth, _x, _next});
  to_host(_next, forces);
}

template <class ExecutionSpace, Law law>
template <Law of>
double SolverOn<ExecutionSpace, law>::largest_row(const ListView<ExecutionSpace, double>& more) const {
  double largest = 0.0;
  Kokkos::parallel_reduce(
      "drogue::fabric::frequency", Kokkos::RangePolicy<ExecutionSpace>(_instance.space(), 0, _vertices),
      FrequencyFunctor<ExecutionSpace, of>{_cloth, _x, more}, Kokkos::Max<double>(largest));
  return largest;
}

template <class ExecutionSpace, Law law>
double SolverOn<ExecutionSpace, law>::fastest_frequency() {
  settle();
  ListView<ExecutionSpace, double> more;
  if (_external.pressure.extent(0) > 0 || _external.bending.first.extent(0) > 0) {
    more = ListView<ExecutionSpace, double>("drogue::fabric::load_stiffness",
                                            static_cast<std::size_t>(_vertices));
    launch_each("drogue::fabric::load_stiffness", _vertices,
                LoadStiffnessFunctor<ExecutionSpace>{loads_at(_x, _v, 0.0, false), more});
  }
  double row = largest_row<law>(more);
  // What is slack now may be taut before it is asked again.
  if constexpr (law.tension_only) row = std::max(row, largest_row<Law{law.model}>(more));
  return std::sqrt(row);
}

template <class ExecutionSpace, Law law>
Totals SolverOn<ExecutionSpace, law>::totals() {
  settle();
  const ExecutionSpace& space = _instance.space();
  const auto fewer = [](int n) { return (n + sum_radix - 1) / sum_radix; };
  int rows = fewer(_vertices);
  Cloth<ExecutionSpace> dead_alone = _cloth;
  dead_alone.load = _dead;
  TotalsView<ExecutionSpace> sums("drogue::fabric::totals", static_cast<std::size_t>(rows));
  Kokkos::parallel_for(
      "drogue::fabric::totals", Kokkos::RangePolicy<ExecutionSpace>(space, 0, rows),
      TotalsFunctor<ExecutionSpace, law>{dead_alone, _x, _v, _pull, _external.bending, sums, _vertices});
  while (rows > 1) {
    rows = fewer(rows);
    const TotalsView<ExecutionSpace> next("drogue::fabric::totals", static_cast<std::size_t>(rows));
    Kokkos::parallel_for("drogue::fabric::sum", Kokkos::RangePolicy<ExecutionSpace>(space, 0, rows),
                         SumFunctor<ExecutionSpace>{sums, next});
    sums = next;
  }
  const auto mirror = Kokkos::create_mirror_view(sums);
  device::copy(space, mirror, sums);
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

template <class ExecutionSpace, Law law>
void SolverOn<ExecutionSpace, law>::contact_work(std::span<ContactWork> of_vertices) {
  settle();
  require_one_a_vertex(of_vertices.size());
  std::ranges::fill(of_vertices, ContactWork{});
  if (_contact) _contact->work(of_vertices);
}

template <class ExecutionSpace, Law law>
void SolverOn<ExecutionSpace, law>::set_contact_work(std::span<const ContactWork> of_vertices) {
  settle();
  require_one_a_vertex(of_vertices.size());
  if (_contact) _contact->set_work(of_vertices);
}

}  // namespace drogue::fabric
