#pragma once

#include <KokkosBatched_Pttrf.hpp>
#include <KokkosBatched_Pttrs.hpp>
#include <Kokkos_Core.hpp>

namespace drogue::perf::tridiagonal {

/// Solves system k in place: the matrix becomes its factors L and D, the right-hand side the unknowns.
template <class Diagonal, class OffDiagonal, class Right>
struct SpdFunctor {
  Diagonal diagonal;
  OffDiagonal off_diagonal;
  Right right;

  KOKKOS_FUNCTION void operator()(int k) const {
    const auto d = Kokkos::subview(diagonal, k, Kokkos::ALL),
               e = Kokkos::subview(off_diagonal, k, Kokkos::ALL), b = Kokkos::subview(right, k, Kokkos::ALL);
    KokkosBatched::SerialPttrf<KokkosBatched::Algo::Pttrf::Unblocked>::invoke(d, e);
    KokkosBatched::SerialPttrs<KokkosBatched::Uplo::Lower, KokkosBatched::Algo::Pttrs::Unblocked>::invoke(
        d, e, b);
  }
};

/// Solves symmetric positive definite tridiagonal systems in place. `diagonal` (batch, n) and `off_diagonal`
/// (batch, n - 1), elements (i, i + 1), become their factors; `right` (batch, n) becomes the unknowns.
/// Asynchronous, does not throw. An indefinite matrix is not detected, and its solution is meaningless.
template <class ExecutionSpace, class Diagonal, class OffDiagonal, class Right>
void solve_spd(const ExecutionSpace& space, const Diagonal& diagonal, const OffDiagonal& off_diagonal,
               const Right& right) {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Diagonal::memory_space>::accessible);
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename OffDiagonal::memory_space>::accessible);
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Right::memory_space>::accessible);
  const Kokkos::RangePolicy<ExecutionSpace> systems(space, 0, diagonal.extent_int(0));
  Kokkos::parallel_for("drogue::perf::solve_spd", systems,
                       SpdFunctor<Diagonal, OffDiagonal, Right>{diagonal, off_diagonal, right});
}

}  // namespace drogue::perf::tridiagonal
