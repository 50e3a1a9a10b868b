#pragma once

#include <memory>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/options/cos/exercise_dates.hpp"

namespace drogue::options {

/// Put with the exercise dates `exercise_date(maturity, k, dates)`, k = 1 .. dates. Unit of money: the
/// strike.
struct BermudanPut {
  double x = 0.0;         ///< log(spot / strike)
  double rate = 0.0;      ///< per year
  double maturity = 1.0;  ///< years
  double low = -1.0;      ///< lower end of the interval of the cosine series, in x
  double width = 2.0;     ///< length of the interval
  int dates = 4;
  int log_terms = 6;  ///< binary logarithm of the number of cosines
  int table = 0;      ///< index of psi(0) in the tables of psi(pi k / width), k = 0 .. number of cosines - 1
};

/// Continuation value now, in strikes, and its derivatives.
struct BermudanValue {
  double value = 0.0;
  double first_derivative = 0.0;   ///< by x
  double second_derivative = 0.0;  ///< by x, twice
  double theta = 0.0;              ///< by time at fixed x, 1/year
};

/// Prices Bermudan puts by the COS method (Fang and Oosterlee 2009). In an exact build all backends give the
/// same bits. The bits of a value do not depend on the other puts of the span.
class BermudanSolver {
 public:
  virtual ~BermudanSolver() = default;

  /// Computes `values`, of the length of `puts`, which are sorted by their number of cosines. `psi_re` and
  /// `psi_im` are the tables of characteristic exponents, 1/year, to which the puts refer. Blocking.
  virtual void solve(std::span<const BermudanPut> puts, std::span<const double> psi_re,
                     std::span<const double> psi_im, std::span<BermudanValue> values) = 0;
};

/// Binary logarithm of the largest number of cosines.
inline constexpr int max_log_terms = 12;

/// Creates a solver on `backend`, which must be compiled in and available. `block`: threads of a team on a
/// device; 0: chosen by Kokkos.
std::unique_ptr<BermudanSolver> create_bermudan_solver(device::Backend backend, int block = 0);

}  // namespace drogue::options
