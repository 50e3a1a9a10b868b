#pragma once

#include <cmath>

#include "kernels/fabric/elastic/dispatch_model.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Upper bound of the largest singular value of a 3 by 3 matrix B, at most 1.8 % above it: the trace of
/// (B^T B)^32 to the power of 1/64.
KOKKOS_INLINE_FUNCTION double spectral_norm_bound(const double (&b)[3][3]) {
  double s[3][3], trace[6];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) s[r][c] = b[0][r] * b[0][c] + b[1][r] * b[1][c] + b[2][r] * b[2][c];
  for (int power = 0; power < 6; ++power) {
    trace[power] = s[0][0] + s[1][1] + s[2][2];
    if (trace[power] == 0.0) return 0.0;
    const double scale = 1.0 / trace[power];
    double scaled[3][3];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) scaled[r][c] = scale * s[r][c];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        s[r][c] = scaled[r][0] * scaled[0][c] + scaled[r][1] * scaled[1][c] + scaled[r][2] * scaled[2][c];
  }
  double root = 1.0;
  for (int power = 5; power > 0; --power) root = device::square_root(trace[power] * root);
  return device::square_root(trace[0] * root);
}

/// Row i of the block norms of M^-1 K, 1/s^2; K is minus the derivative of the elastic forces at the
/// positions x, with geometric stiffness and without pinned axes. By Gershgorin's theorem for blocks
/// (Feingold and Varga 1962) no omega^2 exceeds the largest row.
template <class ExecutionSpace, ConstitutiveModel model>
struct FrequencyFunctor {
  using Dual = device::Dual;
  FabricViews<ExecutionSpace> fabric;
  PointsView<ExecutionSpace> x;
  ListView<ExecutionSpace, double> more;  ///< rows of other stiffness, N/m; may be empty

  KOKKOS_FUNCTION void operator()(const int i, double& largest) const {
    const bool moves = fabric.fixed_dofs(i) != 7U;
    const double other = more.extent(0) > 0 && moves ? more(i) : 0.0;
    const double row = fabric.inverse_mass(i) * (row_sum(i) + other);
    // NaN is no bound.
    const double bound = row >= 0.0 ? row : Kokkos::Experimental::infinity_v<double>;
    if (bound > largest) largest = bound;
  }

  /// Vector with the derivative 1 along `axis`; no derivative for axis -1.
  KOKKOS_FUNCTION static Vector3<Dual> along(const Vector3<double>& v, int axis) {
    return {Dual(v.x, axis == 0 ? 1.0 : 0.0), Dual(v.y, axis == 1 ? 1.0 : 0.0),
            Dual(v.z, axis == 2 ? 1.0 : 0.0)};
  }
  KOKKOS_FUNCTION static EdgeVector<Dual> along(const EdgeVector<double>& edge_to, int axis) {
    const Vector3<Dual> to = along(edge_to.to, axis);
    return {to, dot(to, to), edge_to.neighbour};
  }

  KOKKOS_FUNCTION double is_free(int i, int axis) const {
    return device::Access<double>::unless_set(&fabric.fixed_dofs(i), 1U << static_cast<unsigned>(axis));
  }

  KOKKOS_FUNCTION double row_sum(const int i) const {
    double diagonal[3][3] = {};
    double sum = 0.0;
    // `force_for(axis)` is the force on i while vertex j moves along the axis.
    const auto add = [&](int j, const auto& force_for) {
      double block[3][3];
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3<Dual> p = force_for(axis);
        const double change[3] = {p.x.derivative, p.y.derivative, p.z.derivative};
        for (int r = 0; r < 3; ++r) {
          // Forces are invariant under translations: the diagonal block is minus the sum of the others.
          diagonal[r][axis] += is_free(i, r) * change[r] * is_free(i, axis);
          block[r][axis] = is_free(i, r) * change[r] * is_free(j, axis);
        }
      }
      sum += spectral_norm_bound(block);
    };
    // A spring of no length has no force, but has one as soon as it has a length: until then it counts with
    // the stiffness of a softer model, which has forces at every length.
    if constexpr (whole_triangles<model>)
      each_triangle<double>(
          fabric, x, i,
          [&](const EdgeVector<double>& j, const EdgeVector<double>& k, const RestTriangle<double>& at_rest) {
            const GramMatrix<double>& products = at_rest.products;
            const RestTriangle<Dual> rest{{products.jj, products.jk, products.kk}, at_rest.inverse_area};
            const Vector3<double> third = k.to - j.to;
            const bool vanishes = j.squared == 0.0 || k.squared == 0.0 || dot(third, third) == 0.0;
            const auto force_of = [&](const EdgeVector<Dual>& to_j, const EdgeVector<Dual>& to_k) {
              return vanishes ? triangle_force<ConstitutiveModel{Model::biquadratic}>(fabric.moduli, to_j,
                                                                                      to_k, rest)
                              : triangle_force<model>(fabric.moduli, to_j, to_k, rest);
            };
            add(j.neighbour, [&](int axis) { return force_of(along(j, axis), along(k, -1)); });
            add(k.neighbour, [&](int axis) { return force_of(along(j, -1), along(k, axis)); });
          });
    fabric.springs.each(i, [&](int slot) {
      const int j = fabric.springs.neighbour(slot);
      const Vector3<double> edge = load_points<double>(x, j) - load_points<double>(x, i);
      const Dual stiffness = fabric.springs.value(slot, 0), rest = fabric.springs.value(slot, 1);
      const bool vanishes = dot(edge, edge) == 0.0;
      add(j, [&](int axis) {
        return vanishes ? stiffness * along(edge, axis)
                        : spring_force<model>(stiffness, rest, along(edge, axis));
      });
    });
    return sum + spectral_norm_bound(diagonal);
  }
};

/// Largest row of `FrequencyFunctor`, 1/s^2, over all vertices. Blocks.
template <ConstitutiveModel model, class ExecutionSpace>
[[nodiscard]] double largest_frequency_row(const ExecutionSpace& space,
                                           const FabricViews<ExecutionSpace>& fabric,
                                           const PointsView<ExecutionSpace>& x,
                                           const ListView<ExecutionSpace, double>& more, int vertices) {
  double largest = 0.0;
  Kokkos::parallel_reduce(
      "drogue::fabric::frequency", Kokkos::RangePolicy<ExecutionSpace>(space, 0, vertices),
      FrequencyFunctor<ExecutionSpace, model>{fabric, x, more}, Kokkos::Max<double>(largest));
  return largest;
}

/// Upper bound of the angular frequencies of small oscillations about the positions x, rad/s. Blocks.
template <class ExecutionSpace>
[[nodiscard]] double frequency_bound(const ExecutionSpace& space, const Material& material,
                                     const FabricViews<ExecutionSpace>& fabric,
                                     const PointsView<ExecutionSpace>& x,
                                     const ListView<ExecutionSpace, double>& more, int vertices) {
  return dispatch_model(material, [&]<ConstitutiveModel model>() {
    double row = largest_frequency_row<model>(space, fabric, x, more, vertices);
    // Elements that are slack now may be taut before the next call.
    if constexpr (model.tension_only)
      row = std::max(row,
                     largest_frequency_row<ConstitutiveModel{model.model}>(space, fabric, x, more, vertices));
    return std::sqrt(row);
  });
}

}  // namespace drogue::fabric
