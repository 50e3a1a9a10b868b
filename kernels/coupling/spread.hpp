#pragma once

#include <cmath>

#include "kernels/coupling/grid_transfer.hpp"
#include "kernels/device/relaxed_access.hpp"

namespace drogue::coupling {

// Spreading adds fixed-point numbers, so its result does not depend on the order of points or threads, and
// the sum over all faces of a component is exactly the sum of the forces rounded to units. With n points and
// the largest force component M, a unit is below M n / 2^60; no sum overflows even if all points coincide.

/// Component of the force on a point, N; a View of rank 1 has one value for all components.
template <class Forces>
KOKKOS_INLINE_FUNCTION double force_component(const Forces& force, int i, int component) {
  if constexpr (Forces::rank() == 1)
    return force(i);
  else
    return force(i, component);
}

/// Largest finite magnitude of all force components.
template <class ExecutionSpace, class Forces>
struct LargestForceFunctor {
  GridTransfer<ExecutionSpace> transfer;
  Forces force;

  KOKKOS_FUNCTION void operator()(const int i) const {
    double largest = 0.0;
    for (int component = 0; component < 3; ++component) {
      const double magnitude = Kokkos::fabs(force_component(force, i, component));
      if (magnitude > largest && magnitude <= 1e270) largest = magnitude;
    }
    // Bits of non-negative doubles have the order of their values.
    const auto bits = Kokkos::bit_cast<FixedPoint>(largest);
    if (bits > device::relaxed_load(&transfer.largest(0))) Kokkos::atomic_max(&transfer.largest(0), bits);
  }
};

/// Adds the fixed-point parts of each force to the sums of faces.
template <class Base, class Forces>
struct SpreadFunctor : Base {
  Forces force;
  double bound;  ///< N; zero: the largest force found

  KOKKOS_FUNCTION void operator()(const int n) const {
    // Forces above 1e270 N are rejected: the scale of the fixed-point sums would not be a normal number.
    const double limit = bound > 0.0 ? bound : Kokkos::bit_cast<double>(this->transfer.largest(0));
    const double largest = limit < 1e270 ? limit : 1e270;
    if (n == 0) this->transfer.largest(1) = Kokkos::bit_cast<FixedPoint>(largest);
    const auto at = this->item(n);
    const double value = force_component(force, at.point, at.component);
    if (value == 0.0) return;
    const double coordinates = at.x.x + at.x.y + at.x.z;
    if (!(Kokkos::fabs(value) <= largest) || coordinates - coordinates != 0.0) {
      Kokkos::atomic_add(&this->transfer.counts().rejected_forces, 1LL);
      return;
    }
    const double scaled = value * fixed_point_scale(largest, this->summands).factor;
    const auto add = [&](FaceIndex face, std::int64_t part) {
      if (this->to_own(at.component, face))
        Kokkos::atomic_add(&this->sums.at(at.component, face), static_cast<FixedPoint>(part));
    };
    // The centre receives the remainder, so that the parts add up to the rounded force.
    std::int64_t remainder = to_fixed_point(scaled);
    const FaceStencil<Base::delta_function> stencil = this->stencil(at);
    stencil.for_each_face([&](const FaceIndex& face, double weight, bool is_centre) {
      if (is_centre) return;
      const std::int64_t part = to_fixed_point(weight * scaled);
      remainder -= part;
      add(face, part);
    });
    add(stencil.centre(), remainder);
  }
};

/// Adds the sums of faces to densities and resets them. Among the points around a face, one takes its sum.
template <class Base, class T>
struct AddDensitiesFunctor : Base {
  FaceArrays<T> force_density;
  double inverse_volume;  ///< 1/m^3

  KOKKOS_FUNCTION void operator()(const int n) const {
    if (n == 0) this->transfer.largest(0) = 0;
    const auto at = this->item(n);
    const double unit = inverse_volume * this->scale().inverse;
    this->for_each_own_face(at, [&](const FaceIndex& face, double) {
      FixedPoint& sum = this->sums.at(at.component, face);
      if (device::relaxed_load(&sum) == 0) return;
      const FixedPoint taken = Kokkos::atomic_exchange(&sum, FixedPoint{0});
      if (taken != 0) force_density.at(at.component, face) += unit * from_fixed_point(taken);
    });
  }
};

/// Interpolates the sums of faces.
template <class Base, class Results>
struct RowSumFunctor : Base {
  double inverse_mass;  ///< one over the mass of fluid in a cell, 1/kg
  Results result;

  KOKKOS_FUNCTION void operator()(const int n) const {
    const auto at = this->item(n);
    const double sum = this->weighted_sum(at, [&](int component, const FaceIndex& face) {
      return from_fixed_point(this->sums.at(component, face));
    });
    result(at.point, at.component) = inverse_mass * this->scale().inverse * sum;
  }
};

/// Resets the sums of faces around all points.
template <class Base>
struct ResetSumsFunctor : Base {
  KOKKOS_FUNCTION void operator()(const int n) const {
    if (n == 0) this->transfer.largest(0) = 0;
    const auto at = this->item(n);
    this->for_each_own_face(at, [&](const FaceIndex& face, double) {
      device::relaxed_store(&this->sums.at(at.component, face), FixedPoint{0});
    });
  }
};

/// Adds forces to the fixed-point sums of faces. `bound` (N) and errors are those of `spread`, which throws
/// std::invalid_argument for a bound that is not finite or negative.
template <class ExecutionSpace, class Forces>
void add_to_sums(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer,
                 const Forces& force, double bound) {
  static_assert(spatial::accessible_from<ExecutionSpace, Forces>);
  require_points(transfer, force);
  if (!(bound >= 0.0) || std::isinf(bound))
    throw std::invalid_argument("grid transfer: the bound on forces must be finite and not negative");
  if (bound == 0.0)
    device::launch_each(space, "drogue::coupling::largest_force", transfer.points,
                        LargestForceFunctor<ExecutionSpace, Forces>{transfer, force});
  for_each_point_and_component(space, "drogue::coupling::spread", transfer,
                               [&]<class Base>(const Base& base) {
                                 return SpreadFunctor<Base, Forces>{base, force, bound};
                               });
}

/// Spreads forces on the frozen positions, `force` (points, 3), N, and adds their densities, N/m^3, to
/// `force_density` at the faces; impulses give impulse densities likewise. A rank-1 `force` (points) acts
/// along all axes. The work grows with the points, not with the grid.
///
/// The result has the same bits for any order of points and threads. `bound`, N, states a magnitude that no
/// component exceeds, and fixes the resolution; larger components are not spread but counted in
/// `TransferCounts`, as are those that are not finite. Zero finds the largest component on the device, with
/// one more launch. Asynchronous, allocates nothing, and may be captured into a CUDA graph. Throws
/// std::invalid_argument for Views of the wrong extents and a bound that is negative or not finite.
template <class ExecutionSpace, class Forces, class View>
void spread(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer, const Forces& force,
            const FaceViews<View>& force_density, double bound = 0.0) {
  static_assert(spatial::accessible_from<ExecutionSpace, View>);
  const auto arrays = face_arrays(transfer.window, force_density);
  add_to_sums(space, transfer, force, bound);
  for_each_point_and_component(
      space, "drogue::coupling::add_densities", transfer, [&]<class Base>(const Base& base) {
        using T = typename View::value_type;
        return AddDensitiesFunctor<Base, T>{base, arrays, 1.0 / cell_volume(transfer.grid)};
      });
}

/// Sets values at the faces around all points to zero.
template <class Base, class T>
struct ClearFacesFunctor : Base {
  FaceArrays<T> values;

  KOKKOS_FUNCTION void operator()(const int n) const {
    const auto at = this->item(n);
    this->for_each_own_face(at, [&](const FaceIndex& face, double) { values.at(at.component, face) = T(0); });
  }
};

/// Sets `force_density`, N/m^3, to zero at all faces that `spread` may have changed since the positions were
/// frozen. Asynchronous, allocates nothing, and may be captured into a CUDA graph. Throws
/// std::invalid_argument for Views of the wrong extents.
template <class ExecutionSpace, class View>
void clear_spread(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer,
                  const FaceViews<View>& force_density) {
  static_assert(spatial::accessible_from<ExecutionSpace, View>);
  const auto arrays = face_arrays(transfer.window, force_density);
  for_each_point_and_component(space, "drogue::coupling::clear_spread", transfer,
                               [&]<class Base>(const Base& base) {
                                 using T = typename View::value_type;
                                 return ClearFacesFunctor<Base, T>{base, arrays};
                               });
}

/// Row sums of interpolation after spreading, divided by the fluid density: `result` (points, 3), m^2/kg,
/// from the areas of the points, m^2, and a density, kg/m^3. The inverse of a row sum is the fluid mass per
/// area that moves with a point. Asynchronous, allocates nothing, and may be captured into a CUDA graph.
/// Throws std::invalid_argument for Views of the wrong extents and a density that is not positive.
template <class ExecutionSpace, class Areas, class Results>
void spread_row_sums(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer,
                     const Areas& area, double density, const Results& result) {
  static_assert(Areas::rank() == 1 && spatial::accessible_from<ExecutionSpace, Results>);
  require_points(transfer, result);
  if (!(density > 0.0)) throw std::invalid_argument("grid transfer: the density must be positive");
  add_to_sums(space, transfer, area, 0.0);
  for_each_point_and_component(
      space, "drogue::coupling::row_sums", transfer, [&]<class Base>(const Base& base) {
        return RowSumFunctor<Base, Results>{base, 1.0 / (density * cell_volume(transfer.grid)), result};
      });
  for_each_point_and_component(space, "drogue::coupling::reset_sums", transfer,
                               [&]<class Base>(const Base& base) { return ResetSumsFunctor<Base>{base}; });
}

}  // namespace drogue::coupling
