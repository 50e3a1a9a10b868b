#pragma once

#include <complex>

#include "kernels/options/contract.hpp"

namespace drogue::options {

/// Characteristic exponent psi, 1/year, of the logarithm X of the asset price (time in years):
/// E exp(i u (X_t - X_0)) = exp(t psi(u)), with psi(-i) = rate - dividend. Analytic except for cuts on the
/// imaginary axis outside the strip -1 <= Im u <= 0. Does not throw.
class CharacteristicExponent {
 public:
  /// The contract must satisfy `violated_condition`.
  explicit CharacteristicExponent(const Contract& contract);

  [[nodiscard]] std::complex<double> operator()(std::complex<double> u) const;

  /// Exponent under the dual measure, whose numeraire is the asset: psi(-u - i) - psi(-i). A call is a put on
  /// the dual process with spot and strike, and rate and dividend, exchanged.
  [[nodiscard]] CharacteristicExponent dual() const;

  /// Drift of X, 1/year. For large real u, psi(u) - i drift() u is even up to a bounded part.
  [[nodiscard]] double drift() const { return _drift; }

  /// Mean, variance and fourth cumulant of X_1 - X_0.
  struct Cumulants {
    double mean, second, fourth;
  };
  [[nodiscard]] Cumulants cumulants() const;

  /// Jumps of X at which the tails of the jump density have decayed by exp(-jump_range_digits). At short
  /// maturities they determine the range of X, and not its standard deviation.
  struct JumpRange {
    double down, up;
  };
  static constexpr double jump_range_digits = 23.0;
  [[nodiscard]] JumpRange jump_range() const;

 private:
  [[nodiscard]] std::complex<double> primal(std::complex<double> u) const;
  [[nodiscard]] std::complex<double> jump_exponent(std::complex<double> u) const;
  [[nodiscard]] std::complex<double> generalized_hyperbolic(std::complex<double> u) const;

  Contract _contract;
  bool _is_dual = false;
  double _drift = 0.0;
  double _log_gamma_squared = 0.0;  ///< log(alpha^2 - beta^2)
  double _log_k = 0.0;              ///< log K_lambda(delta gamma)
};

}  // namespace drogue::options
