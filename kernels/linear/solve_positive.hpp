#pragma once

#include <KokkosBatched_Pttrf.hpp>
#include <KokkosBatched_Pttrs.hpp>
#include <Kokkos_Core.hpp>

namespace drogue::linear {

/// Member k of a batch: its matrix becomes L and D, its right side the unknowns.
template <class Diagonal, class Beside, class Right>
struct PositiveFunctor {
  Diagonal diagonal;
  Beside beside;
  Right right;

  KOKKOS_FUNCTION void operator()(int k) const {
    const auto d = Kokkos::subview(diagonal, k, Kokkos::ALL), e = Kokkos::subview(beside, k, Kokkos::ALL),
               b = Kokkos::subview(right, k, Kokkos::ALL);
    KokkosBatched::SerialPttrf<KokkosBatched::Algo::Pttrf::Unblocked>::invoke(d, e);
    KokkosBatched::SerialPttrs<KokkosBatched::Uplo::Lower, KokkosBatched::Algo::Pttrs::Unblocked>::invoke(
        d, e, b);
  }
};

/// Enqueues the solution of symmetric positive definite tridiagonal systems, in place: `diagonal` (batch, n)
/// and `beside` (batch, n - 1), elements (i, i + 1), become their factors, `right` (batch, n) the unknowns. A
/// matrix that is not positive definite is not found out and gives numbers without meaning.
template <class ExecutionSpace, class Diagonal, class Beside, class Right>
void solve_positive(const ExecutionSpace& space, const Diagonal& diagonal, const Beside& beside,
                    const Right& right) {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Diagonal::memory_space>::accessible);
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Beside::memory_space>::accessible);
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Right::memory_space>::accessible);
  const Kokkos::RangePolicy<ExecutionSpace> members(space, 0, diagonal.extent_int(0));
  Kokkos::parallel_for("drogue::linear::solve positive", members,
                       PositiveFunctor<Diagonal, Beside, Right>{diagonal, beside, right});
}

}  // namespace drogue::linear
