#pragma once

#include <Kokkos_Macros.hpp>

namespace drogue::options {

/// Years from now to date k of a put with `dates` exercise dates, k = 0 .. dates: T s (s + c)/(1 + c), s =
/// k/dates. The dates are dense now: the value of a Bermudan put differs from that of an American one by the
/// gain until the next date, and is smooth at the present exercise boundary within a deviation of that
/// interval, where no extrapolation in the number of dates converges. All levels are values of one smooth
/// function of k/dates, as extrapolation requires. c = 0 would need cosines as many as dates.
KOKKOS_INLINE_FUNCTION double exercise_date(double maturity, int k, int dates) {
  constexpr double c = 0.1;
  const double s = static_cast<double>(k) / dates;
  return maturity * s * (s + c) / (1.0 + c);
}

}  // namespace drogue::options
