#pragma once

#include "kernels/coupling/parameters.hpp"
#include "kernels/device/pack.hpp"

namespace drogue::coupling {

// Regularised delta functions in one dimension, scaled by the spacing: weights of the sample points around a
// position. Sample points are the integers. `base` is the floor of the position, or the nearest integer where
// `centred`; the weights belong to the sample points base - lead, base - lead + 1, ...

/// Linear B-spline (order 2). r: position minus base, in spacings, 0 to 1.
struct LinearSpline {
  static constexpr int points = 2, lead = 0;
  static constexpr bool centred = false;

  /// Weights of the sample points, dimensionless, for r in spacings. Does not throw.
  template <class R>
  KOKKOS_INLINE_FUNCTION static void weights(const R& r, R (&w)[points]) {
    w[0] = 1.0 - r;
    w[1] = r;
  }
};

/// Quadratic B-spline (order 3). r: position minus base, in spacings, -1/2 to 1/2.
struct QuadraticSpline {
  static constexpr int points = 3, lead = 1;
  static constexpr bool centred = true;

  /// Weights of the sample points, dimensionless, for r in spacings. Does not throw.
  template <class R>
  KOKKOS_INLINE_FUNCTION static void weights(const R& r, R (&w)[points]) {
    const R low = 0.5 - r, high = 0.5 + r;
    w[0] = 0.5 * (low * low);
    w[1] = 0.75 - r * r;
    w[2] = 0.5 * (high * high);
  }
};

/// Cubic B-spline (order 4). r: position minus base, in spacings, 0 to 1.
struct CubicSpline {
  static constexpr int points = 4, lead = 1;
  static constexpr bool centred = false;

  /// Weights of the sample points, dimensionless, for r in spacings. Does not throw.
  template <class R>
  KOKKOS_INLINE_FUNCTION static void weights(const R& r, R (&w)[points]) {
    constexpr double sixth = 1.0 / 6.0, two_thirds = 2.0 / 3.0;
    const R t = 1.0 - r, r2 = r * r, t2 = t * t;
    w[0] = sixth * (t2 * t);
    w[1] = two_thirds - r2 + 0.5 * (r2 * r);
    w[2] = two_thirds - t2 + 0.5 * (t2 * t);
    w[3] = sixth * (r2 * r);
  }
};

/// Four-point function (Peskin, Acta Numerica 2002, eq. 6.27). r: position minus base, in spacings, 0 to 1.
struct PeskinFourPoint {
  static constexpr int points = 4, lead = 1;
  static constexpr bool centred = false;

  /// Weights of the sample points, dimensionless, for r in spacings. Does not throw.
  template <class R>
  KOKKOS_INLINE_FUNCTION static void weights(const R& r, R (&w)[points]) {
    using device::square_root;
    const R root = 0.125 * square_root(1.0 + 4.0 * (r * (1.0 - r)));
    const R low = 0.375 - 0.25 * r, high = 0.125 + 0.25 * r;
    w[0] = low - root;
    w[1] = low + root;
    w[2] = high + root;
    w[3] = high - root;
  }
};

/// One-dimensional factors of a delta function for component d: along axis d and across it.
template <DeltaFunction delta>
struct DeltaFactors;

template <>
struct DeltaFactors<DeltaFunction::cbs43> {
  using Along = CubicSpline;
  using Across = QuadraticSpline;
};
template <>
struct DeltaFactors<DeltaFunction::cbs32> {
  using Along = QuadraticSpline;
  using Across = LinearSpline;
};
template <>
struct DeltaFactors<DeltaFunction::ib4> {
  using Along = PeskinFourPoint;
  using Across = PeskinFourPoint;
};

/// Calls `function.operator()<delta>()` with a delta function chosen at run time. Throws what the function
/// throws.
template <class Function>
void dispatch_delta(DeltaFunction delta, const Function& function) {
  switch (delta) {
    case DeltaFunction::cbs43:
      return function.template operator()<DeltaFunction::cbs43>();
    case DeltaFunction::cbs32:
      return function.template operator()<DeltaFunction::cbs32>();
    case DeltaFunction::ib4:
      return function.template operator()<DeltaFunction::ib4>();
  }
}

}  // namespace drogue::coupling
