#pragma once

#include "kernels/device/expression.hpp"
#include "kernels/fabric/elastic/stress.hpp"
#include "kernels/fabric/views.hpp"
#include "kernels/stepping/step_monitor.hpp"

namespace drogue::fabric {

template <class ExecutionSpace>
using ProgramsView = ListView<ExecutionSpace, device::ExpressionProgram>;

/// Loads other than elastic and dead forces. Views of absent loads are empty.
template <class ExecutionSpace>
struct External {
  using Memory = typename ExecutionSpace::memory_space;
  PointsView<ExecutionSpace> rest;                                   ///< (vertices, 3), m
  ProgramsView<ExecutionSpace> load;                                 ///< strengths of timed loads
  Kokkos::View<double** [3], Kokkos::LayoutLeft, Memory> direction;  ///< (vertices, loads, 3), N
  ProgramsView<ExecutionSpace> pressure;                             ///< strengths of pressures, Pa
  Kokkos::View<double**, Kokkos::LayoutLeft, Memory> weight;         ///< (vertices, pressures)
  SlicedEllViews<ExecutionSpace, 3> surface;                         ///< rings; their values are not read
  SlicedEllViews<ExecutionSpace, 1> dashpots, bending;

  [[nodiscard]] KOKKOS_FUNCTION bool has_pressure() const { return pressure.extent(0) > 0; }

  /// `sum`, N, and the timed loads on vertex i, at rest at `at_rest`, m, at time `t`, s.
  KOKKOS_INLINE_FUNCTION Vector3<double> with_timed_loads(Vector3<double> sum, int i,
                                                          const Vector3<double>& at_rest, double t) const {
    for (int k = 0; k < static_cast<int>(load.extent(0)); ++k) {
      const double strength = device::evaluate(load(k), at_rest.x, at_rest.y, at_rest.z, t);
      sum = sum + strength * Vector3<double>{direction(i, k, 0), direction(i, k, 1), direction(i, k, 2)};
    }
    return sum;
  }

  /// Pressure at vertex i, Pa.
  KOKKOS_INLINE_FUNCTION double pressure_at(int i, const Vector3<double>& at_rest, double t) const {
    double sum = 0.0;
    for (int k = 0; k < static_cast<int>(pressure.extent(0)); ++k)
      sum += weight(i, k) * device::evaluate(pressure(k), at_rest.x, at_rest.y, at_rest.z, t);
    return sum;
  }
};

/// Twice the area vector of the triangles of vertex i, m^2. `rings` holds the ring adjacency, `x` positions,
/// m, indexed by its neighbour numbers.
template <class Rings, class Points>
KOKKOS_INLINE_FUNCTION Vector3<double> twice_area_vector(const Rings& rings, const Points& x, int i) {
  const Vector3<double> own = load_points<double>(x, i);
  Vector3<double> twice_area{0.0, 0.0, 0.0};
  rings.each_pair(
      i, [&](int slot) { return rings.neighbour(slot); },
      [&](int, int neighbour) { return load_points<double>(x, neighbour) - own; },
      [&](const Vector3<double>& to_j, const Vector3<double>& to_k, int) {
        twice_area = twice_area + cross(to_j, to_k);
      });
  return twice_area;
}

/// Force of a dashpot, N, on the start of `edge`, m. It acts along the edge, so that the forces on both ends
/// cancel and have no torque. `faster` is the velocity of the other end relative to this one, m/s.
KOKKOS_INLINE_FUNCTION Vector3<double> one_dashpot_force(double dashpot, const Vector3<double>& edge,
                                                         const Vector3<double>& faster) {
  const double squared = dot(edge, edge);
  return (squared > 0.0 ? dashpot * dot(faster, edge) / squared : 0.0) * edge;
}

/// Force of all dashpots on vertex i, N.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<double> dashpot_force(const SlicedEllViews<ExecutionSpace, 1>& dashpots,
                                                     const PointsView<ExecutionSpace>& x,
                                                     const PointsView<ExecutionSpace>& v, int i) {
  const Vector3<double> own = load_points<double>(x, i), velocity = load_points<double>(v, i);
  Vector3<double> sum{0.0, 0.0, 0.0};
  struct Dashpot {
    double coefficient;
    Vector3<double> edge, faster;
  };
  dashpots.each_read(
      i,
      [&](int slot) {
        const int j = dashpots.neighbour(slot);
        return Dashpot{dashpots.value(slot, 0), load_points<double>(x, j) - own,
                       load_points<double>(v, j) - velocity};
      },
      [&](const Dashpot& of) { sum = sum + one_dashpot_force(of.coefficient, of.edge, of.faster); });
  return sum;
}

/// Bending force on vertex i, N.
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

/// Sum of all loads on every vertex, N: dead forces, timed loads, pressures, bending and, if `with_dashpots`,
/// dashpots.
template <class ExecutionSpace>
struct ExternalFunctor {
  External<ExecutionSpace> external;
  PointsView<ExecutionSpace> dead;  ///< may be empty
  PointsView<ExecutionSpace> x, v, out;
  stepping::StageTime<ExecutionSpace> stage_time;
  bool with_dashpots;

  KOKKOS_FUNCTION double pressure_on(int i, const Vector3<double>& at_rest) const {
    return external.pressure_at(i, at_rest, stage_time.time());
  }

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Vector3<double> at_rest = load_points<double>(external.rest, i);
    Vector3<double> sum{0.0, 0.0, 0.0};
    if (dead.extent(0) > 0) sum = load_points<double>(dead, i);
    sum = external.with_timed_loads(sum, i, at_rest, stage_time.time());
    if (external.has_pressure())
      sum = sum + (pressure_on(i, at_rest) / 6.0) * twice_area_vector(external.surface, x, i);
    if (external.bending.first.extent(0) > 0) sum = sum + bending_force(external.bending, x, i);
    if (with_dashpots) sum = sum + dashpot_force(external.dashpots, x, v, i);
    store_points(out, i, sum);
  }
};

/// Contribution of pressure and bending to the rows of `FrequencyFunctor`, N/m. Derivatives of a third of the
/// area (x_j - x_i) x (x_k - x_i) / 2 are cross products with an edge over 6, at the present pressure.
template <class ExecutionSpace>
struct LoadStiffnessFunctor {
  ExternalFunctor<ExecutionSpace> loads;
  ListView<ExecutionSpace, double> out;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const External<ExecutionSpace>& external = loads.external;
    double row = 0.0;
    if (external.has_pressure()) {
      const Vector3<double> at_rest = load_points<double>(external.rest, i);
      row = Kokkos::fabs(loads.pressure_on(i, at_rest)) / 6.0 * edge_lengths_at(i);
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

  /// Sum of the edge lengths of the triangles of vertex i, m, each edge once per triangle.
  KOKKOS_FUNCTION double edge_lengths_at(const int i) const {
    const auto& surface = loads.external.surface;
    const Vector3<double> own = load_points<double>(loads.x, i);
    const auto length = [](const Vector3<double>& a) { return device::square_root(dot(a, a)); };
    double edges = 0.0;
    surface.each_pair(
        i, [&](int slot) { return surface.neighbour(slot); },
        [&](int, int neighbour) { return load_points<double>(loads.x, neighbour) - own; },
        [&](const Vector3<double>& to_j, const Vector3<double>& to_k, int) {
          // Neutral slots have edges of length zero.
          if (dot(to_j, to_j) > 0.0 && dot(to_k, to_k) > 0.0)
            edges += length(to_j) + length(to_k) + length(to_k - to_j);
        });
    return edges;
  }
};

}  // namespace drogue::fabric
