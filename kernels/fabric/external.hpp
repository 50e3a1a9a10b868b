#pragma once

#include "kernels/device/expression.hpp"
#include "kernels/fabric/elastic/stress.hpp"
#include "kernels/fabric/timing.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

template <class ExecutionSpace>
using ProgramsView = ListView<ExecutionSpace, device::ExpressionProgram>;

/// What acts on cloth beside its elasticity and dead loads, in a kernel of its own that scenes without it do
/// not launch. Views of what a scene does not have are empty.
template <class ExecutionSpace>
struct External {
  using Memory = typename ExecutionSpace::memory_space;
  PointsView<ExecutionSpace> rest;
  ProgramsView<ExecutionSpace> load;
  Kokkos::View<double** [3], Kokkos::LayoutLeft, Memory> direction;  ///< vertex, load
  ProgramsView<ExecutionSpace> pressure;
  Kokkos::View<double**, Kokkos::LayoutLeft, Memory> weight;  ///< vertex, pressure
  SlicedEllViews<ExecutionSpace, 3> surface;                  ///< rings; nobody reads its values
  SlicedEllViews<ExecutionSpace, 1> dashpots, bending;
};

/// The pull of a dashpot on the end from which `edge` leads, N: along the edge alone, so that the pull on the
/// other end is its opposite and both have no torque. `faster` is the other end's velocity less the own.
KOKKOS_INLINE_FUNCTION Vector3<double> dashpot_pull(double dashpot, const Vector3<double>& edge,
                                                    const Vector3<double>& faster) {
  const double squared = dot(edge, edge);
  return (squared > 0.0 ? dashpot * dot(faster, edge) / squared : 0.0) * edge;
}

/// The pulls of all dashpots on vertex i, N.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<double> dashpot_force(const SlicedEllViews<ExecutionSpace, 1>& dashpots,
                                                     const PointsView<ExecutionSpace>& x,
                                                     const PointsView<ExecutionSpace>& v, int i) {
  const Vector3<double> own = load_points<double>(x, i), velocity = load_points<double>(v, i);
  Vector3<double> sum{0.0, 0.0, 0.0};
  dashpots.each(i, [&](int slot) {
    const int j = dashpots.neighbour(slot);
    sum = sum + dashpot_pull(dashpots.value(slot, 0), load_points<double>(x, j) - own,
                             load_points<double>(v, j) - velocity);
  });
  return sum;
}

/// The resistance of vertex i to bending, N.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<double> bending_force(const SlicedEllViews<ExecutionSpace, 1>& bending,
                                                     const PointsView<ExecutionSpace>& x, int i) {
  const Vector3<double> own = load_points<double>(x, i);
  Vector3<double> sum{0.0, 0.0, 0.0};
  bending.each(i, [&](int slot) {
    sum = sum + bending.value(slot, 0) * (load_points<double>(x, bending.neighbour(slot)) - own);
  });
  return sum;
}

/// The loads on every vertex, N: dead ones, those that change, pressures, bending, and with `damps` dashpots.
template <class ExecutionSpace>
struct ExternalFunctor {
  External<ExecutionSpace> external;
  PointsView<ExecutionSpace> dead;  ///< may be empty
  PointsView<ExecutionSpace> x, v, out;
  Timing<ExecutionSpace> timing;
  bool damps;

  KOKKOS_FUNCTION double pressure_on(int i, const Vector3<double>& place) const {
    double sum = 0.0;
    for (int k = 0; k < static_cast<int>(external.pressure.extent(0)); ++k)
      sum += external.weight(i, k) *
             device::evaluate(external.pressure(k), place.x, place.y, place.z, timing.time());
    return sum;
  }

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Vector3<double> place = load_points<double>(external.rest, i);
    Vector3<double> sum{0.0, 0.0, 0.0};
    if (dead.extent(0) > 0) sum = load_points<double>(dead, i);
    for (int k = 0; k < static_cast<int>(external.load.extent(0)); ++k) {
      const double strength = device::evaluate(external.load(k), place.x, place.y, place.z, timing.time());
      sum = sum + strength * Vector3<double>{external.direction(i, k, 0), external.direction(i, k, 1),
                                             external.direction(i, k, 2)};
    }
    if (external.pressure.extent(0) > 0) {
      const Vector3<double> own = load_points<double>(x, i);
      Vector3<double> twice_area{0.0, 0.0, 0.0};
      external.surface.each_pair(
          i, [&](int slot) { return external.surface.neighbour(slot); },
          [&](int, int neighbour) { return load_points<double>(x, neighbour) - own; },
          [&](const Vector3<double>& to_j, const Vector3<double>& to_k, int) {
            twice_area = twice_area + cross(to_j, to_k);
          });
      sum = sum + (pressure_on(i, place) / 6.0) * twice_area;
    }
    if (external.bending.first.extent(0) > 0) sum = sum + bending_force(external.bending, x, i);
    if (damps) sum = sum + dashpot_force(external.dashpots, x, v, i);
    store_points(out, i, sum);
  }
};

/// What pressure and bending add to the rows of `FrequencyFunctor`, N/m. Derivatives of a third of the area
/// (x_j - x_i) x (x_k - x_i) / 2 are cross products with an edge over 6, at the present pressure.
template <class ExecutionSpace>
struct LoadStiffnessFunctor {
  ExternalFunctor<ExecutionSpace> loads;
  ListView<ExecutionSpace, double> out;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const External<ExecutionSpace>& external = loads.external;
    double row = 0.0;
    if (external.pressure.extent(0) > 0) {
      const Vector3<double> place = load_points<double>(external.rest, i);
      row = Kokkos::fabs(loads.pressure_on(i, place)) / 6.0 * edges_about(i);
    }
    if (external.bending.first.extent(0) > 0) {
      double diagonal = 0.0;
      external.bending.each(i, [&](int slot) {
        const double weight = external.bending.value(slot, 0);
        row += Kokkos::fabs(weight), diagonal += weight;
      });
      row += Kokkos::fabs(diagonal);
    }
    out(i) = row;
  }

  /// The edges of the triangles of vertex i, m, each as often as there are triangles.
  KOKKOS_FUNCTION double edges_about(const int i) const {
    const auto& surface = loads.external.surface;
    const Vector3<double> own = load_points<double>(loads.x, i);
    const auto length = [](const Vector3<double>& a) { return device::square_root(dot(a, a)); };
    double edges = 0.0;
    surface.each_pair(
        i, [&](int slot) { return surface.neighbour(slot); },
        [&](int, int neighbour) { return load_points<double>(loads.x, neighbour) - own; },
        [&](const Vector3<double>& to_j, const Vector3<double>& to_k, int) {
          // Not of the triangles without area that stand for none.
          if (dot(to_j, to_j) > 0.0 && dot(to_k, to_k) > 0.0)
            edges += length(to_j) + length(to_k) + length(to_k - to_j);
        });
    return edges;
  }
};

/// Velocity Verlet's share of dashpots: they act on the velocities in the middle of a step, for all of it,
/// and the drift follows. Stable where dt times the fastest decay is at most 1.
template <class ExecutionSpace>
struct DragFunctor {
  Cloth<ExecutionSpace> cloth;
  SlicedEllViews<ExecutionSpace, 1> dashpots;
  PointsView<ExecutionSpace> x, v, dragged, next;
  double dt;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Vector3<double> drag = (dt * cloth.inverse_mass(i)) * dashpot_force(dashpots, x, v, i),
                          free = free_axes<double>(cloth, i);
    const Vector3<double> velocity =
        load_points<double>(v, i) + Vector3<double>{free.x * drag.x, free.y * drag.y, free.z * drag.z};
    store_points(dragged, i, velocity);
    store_points(next, i, load_points<double>(x, i) + dt * velocity);
  }
};

}  // namespace drogue::fabric
