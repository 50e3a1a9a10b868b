#pragma once

#include <complex>

#include "kernels/options/contract.hpp"

namespace drogue::options {

/// The characteristic exponent of the logarithm X of the asset's price: E exp(i u (X_t - X_0)) = exp(t
/// psi(u)), psi(-i) = rate - dividend. Analytic but for cuts on the imaginary axis outside the strip
/// [-1, 0] of Im u.
class Exponent {
 public:
  /// The contract must satisfy `violated_condition`.
  explicit Exponent(const Contract& contract);

  [[nodiscard]] std::complex<double> operator()(std::complex<double> u) const;

  /// That of the process seen by who counts money in assets: psi(-u - i) - psi(-i). A call is a put on it,
  /// with spot and strike, and rate and dividend, exchanged.
  [[nodiscard]] Exponent dual() const;

  /// psi(u) - i drift() u is even for large real u, but for a bounded part.
  [[nodiscard]] double drift() const { return _drift; }

  /// Of X_1: mean, variance and fourth cumulant.
  struct Cumulants {
    double mean, second, fourth;
  };
  [[nodiscard]] Cumulants cumulants() const;

  /// How far down and up a single jump may go whose probability, weighed with the asset's price, is not
  /// negligible: exp(-reach_digits). At short maturities it is this and no deviation that says where the law
  /// ends.
  static constexpr double reach_digits = 23.0;
  struct Reach {
    double down, up;
  };
  [[nodiscard]] Reach reach() const;

 private:
  [[nodiscard]] std::complex<double> primal(std::complex<double> u) const;
  [[nodiscard]] std::complex<double> jumps(std::complex<double> u) const;
  [[nodiscard]] std::complex<double> hyperbolic(std::complex<double> u) const;

  Contract _contract;
  bool _is_dual = false;
  double _drift = 0.0;
  double _log_gamma_squared = 0.0;  ///< log(alpha^2 - beta^2)
  double _log_k = 0.0;              ///< log K_lambda(delta gamma)
};

}  // namespace drogue::options
