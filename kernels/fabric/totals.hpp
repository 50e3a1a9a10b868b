#pragma once

#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/fabric/elastic/dispatch_model.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Number of values that one thread sums.
inline constexpr int sum_radix = 8;

/// Number of sums: kinetic, elastic, gravity and load energy; momentum; angular momentum.
inline constexpr int total_count = 10;

template <class ExecutionSpace>
using TotalsView = TableView<ExecutionSpace, double, total_count>;

/// Index j sums the contributions of vertices j, j + n_out, j + 2 n_out, ... in this order, so that sums have
/// the same bits on every backend and with any number of threads. Each corner of a triangle has a third of
/// its energy, each end of a spring half.
template <class ExecutionSpace, ConstitutiveModel model>
struct TotalsFunctor {
  FabricViews<ExecutionSpace> fabric;
  PointsView<ExecutionSpace> x, v;
  /// N, of Model::linear_vector, also part of `fabric.load`; may be empty.
  PointsView<ExecutionSpace> rest_forces;
  SlicedEllViews<ExecutionSpace, 1> bending;  ///< may be empty
  TotalsView<ExecutionSpace> out;
  int vertices;

  KOKKOS_FUNCTION void operator()(const int j) const {
    double sum[total_count] = {};
    for (int i = j; i < vertices; i += static_cast<int>(out.extent(0))) add(i, sum);
    for (int k = 0; k < total_count; ++k) out(j, k) = sum[k];
  }

  KOKKOS_FUNCTION void add(int i, double (&sum)[total_count]) const {
    const Vector3<double> at = load_points<double>(x, i), velocity = load_points<double>(v, i);
    const double mass = 1.0 / fabric.inverse_mass(i);
    sum[0] += 0.5 * mass * dot(velocity, velocity);
    sum[1] += elastic(i, at);
    sum[2] -= mass * dot(fabric.gravity, at);
    if (fabric.load.extent(0) > 0) sum[3] -= dot(load_points<double>(fabric.load, i), at);
    if (rest_forces.extent(0) > 0) {
      const double work = dot(load_points<double>(rest_forces, i), at);
      sum[1] -= work, sum[3] += work;
    }
    const double moved[3] = {mass * velocity.x, mass * velocity.y, mass * velocity.z};
    for (int axis = 0; axis < 3; ++axis) sum[4 + axis] += moved[axis];
    sum[7] += at.y * moved[2] - at.z * moved[1];
    sum[8] += at.z * moved[0] - at.x * moved[2];
    sum[9] += at.x * moved[1] - at.y * moved[0];
  }

  KOKKOS_FUNCTION double elastic(int i, const Vector3<double>& own) const {
    double energy = 0.0;
    const auto squared = [](const Vector3<double>& a) { return dot(a, a); };
    const auto to = [&](int neighbour) { return load_points<double>(x, neighbour) - own; };
    if constexpr (whole_triangles<model>)
      each_triangle<double>(
          fabric, x, i,
          [&](const EdgeVector<double>& j, const EdgeVector<double>& k, const RestTriangle<double>& rest) {
            const GramMatrix<double> now{j.squared, dot(j.to, k.to), k.squared};
            energy += membrane_energy<model>(fabric.moduli, squared_edges(now), squared_edges(rest.products),
                                             rest.inverse_area) /
                      3.0;
          });
    fabric.springs.each(i, [&](int slot) {
      energy += 0.5 * spring_energy<model>(fabric.springs.value(slot, 0),
                                           squared(to(fabric.springs.neighbour(slot))),
                                           fabric.springs.value(slot, 1));
    });
    // Weights are minus the second derivatives, whose rows sum to zero: x Q x / 2 over pairs.
    if (bending.first.extent(0) > 0)
      bending.each(i, [&](int slot) {
        energy += 0.25 * bending.value(slot, 0) * squared(to(bending.neighbour(slot)));
      });
    return energy;
  }
};

/// Index j sums rows j, j + n_out, ... of the previous level.
template <class ExecutionSpace>
struct SumFunctor {
  TotalsView<ExecutionSpace> in, out;

  KOKKOS_FUNCTION void operator()(const int j) const {
    const int rows = static_cast<int>(in.extent(0)), step = static_cast<int>(out.extent(0));
    for (int k = 0; k < total_count; ++k) {
      double sum = 0.0;
      for (int row = j; row < rows; row += step) sum += in(row, k);
      out(j, k) = sum;
    }
  }
};

/// Sums over all vertices with memory that is allocated once: totals are evaluated often.
template <class ExecutionSpace>
class TotalsEvaluator {
 public:
  explicit TotalsEvaluator(int vertices) : _vertices(vertices) {
    int rows = vertices;
    do {
      rows = (rows + sum_radix - 1) / sum_radix;
      _levels.emplace_back("drogue::fabric::totals", static_cast<std::size_t>(rows));
    } while (rows > 1);
    _mirror = Kokkos::create_mirror_view(_levels.back());
  }

  /// Totals without contact and without the rest energy of springs of vectors. `fabric.load` holds the dead
  /// loads alone; `rest_forces` and `bending` may be empty. Blocks.
  Totals evaluate(const ExecutionSpace& space, const Material& material,
                  const FabricViews<ExecutionSpace>& fabric, const PointsView<ExecutionSpace>& x,
                  const PointsView<ExecutionSpace>& v, const PointsView<ExecutionSpace>& rest_forces,
                  const SlicedEllViews<ExecutionSpace, 1>& bending) const {
    dispatch_model(material, [&]<ConstitutiveModel model>() {
      Kokkos::parallel_for("drogue::fabric::totals",
                           Kokkos::RangePolicy<ExecutionSpace>(space, 0, _levels.front().extent(0)),
                           TotalsFunctor<ExecutionSpace, model>{.fabric = fabric,
                                                                .x = x,
                                                                .v = v,
                                                                .rest_forces = rest_forces,
                                                                .bending = bending,
                                                                .out = _levels.front(),
                                                                .vertices = _vertices});
    });
    for (std::size_t level = 1; level < _levels.size(); ++level)
      Kokkos::parallel_for("drogue::fabric::sum",
                           Kokkos::RangePolicy<ExecutionSpace>(space, 0, _levels[level].extent(0)),
                           SumFunctor<ExecutionSpace>{_levels[level - 1], _levels[level]});
    device::copy(space, _mirror, _levels.back());
    space.fence("drogue::fabric::totals");
    Totals t{.kinetic = _mirror(0, 0),
             .elastic = _mirror(0, 1),
             .gravity = _mirror(0, 2),
             .load = _mirror(0, 3),
             .contact = 0.0,
             .friction = 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis)
      t.momentum[axis] = _mirror(0, 4 + axis), t.angular_momentum[axis] = _mirror(0, 7 + axis);
    return t;
  }

 private:
  int _vertices;
  std::vector<TotalsView<ExecutionSpace>> _levels;  ///< of the sum; the last one has one row
  typename TotalsView<ExecutionSpace>::host_mirror_type _mirror;
};

}  // namespace drogue::fabric
