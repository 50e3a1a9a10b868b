#pragma once

#include <memory>
#include <span>

#include "kernels/device/backend.hpp"

namespace drogue::options {

/// A put that may be exercised at `dates` equally spaced times after now, the last its maturity. Money is
/// counted in strikes; x is the logarithm of spot / strike.
struct BermudanPut {
  double x = 0.0;
  double rate = 0.0;
  double maturity = 1.0;  ///< years
  double low = -1.0;      ///< the interval of x that cosines are taken on
  double width = 2.0;
  int dates = 4;
  int log_terms = 6;  ///< of the number of cosines
  int table = 0;      ///< where its values of psi(pi k / width), k = 0 .. terms - 1, begin
};

/// The value of waiting now, and its derivatives by x and time (at fixed x, a year).
struct BermudanValue {
  double value = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
  double theta = 0.0;
};

/// Values Bermudan puts by the COS method (Fang and Oosterlee 2009): the same bits on every backend of an
/// exact build and for any composition of the span.
class BermudanSolver {
 public:
  virtual ~BermudanSolver() = default;

  /// `psi_re`, `psi_im` hold the characteristic exponents that the puts refer to.
  virtual void solve(std::span<const BermudanPut> puts, std::span<const double> psi_re,
                     std::span<const double> psi_im, std::span<BermudanValue> values) = 0;
};

/// Most cosines a put may have, as a power of two.
inline constexpr int most_log_terms = 12;

/// The backend must be compiled in and available.
std::unique_ptr<BermudanSolver> create_bermudan_solver(device::Backend backend);

}  // namespace drogue::options
