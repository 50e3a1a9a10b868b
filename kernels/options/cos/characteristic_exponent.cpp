#include "kernels/options/cos/characteristic_exponent.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/options/cos/bessel.hpp"

namespace drogue::options {
namespace {

using Complex = std::complex<double>;
constexpr std::complex<double> imaginary{0.0, 1.0};

/// Radius of the largest disc about 0 in which the exponent is analytic.
double radius_of(const Contract& c, bool is_dual) {
  const double shift = is_dual ? 1.0 : 0.0;
  switch (c.model) {
    case JumpModel::generalized_hyperbolic:
      return c.jump[1] - std::abs(c.jump[2] + shift);
    case JumpModel::kou:
      return std::min(c.jump[2] - shift, c.jump[3] + shift);
    case JumpModel::black_scholes:
    case JumpModel::merton:
      break;
  }
  return 1.0;
}

}  // namespace

CharacteristicExponent::CharacteristicExponent(const Contract& contract) : _contract(contract) {
  const auto [lambda, alpha, beta, delta] = contract.jump;
  if (contract.model == JumpModel::generalized_hyperbolic) {
    _log_gamma_squared = std::log(alpha - beta) + std::log(alpha + beta);
    const double z = delta * std::exp(0.5 * _log_gamma_squared);
    if (delta > 0.0) _log_k = std::real(log_bessel_k(lambda, z)) - z;
  }
  _drift = contract.rate - contract.dividend - 0.5 * contract.variance - std::real(jump_exponent(-imaginary));
}

/// Logarithm of the characteristic function of the generalized hyperbolic distribution (Barndorff-Nielsen
/// 1977),
///   (gamma^2 / w)^(lambda/2) K_lambda(delta sqrt w) / K_lambda(delta gamma),  w = alpha^2 - (beta + i u)^2.
/// w is split into two factors, whose logarithms stay on their branches.
Complex CharacteristicExponent::generalized_hyperbolic(Complex u) const {
  const auto [lambda, alpha, beta, delta] = _contract.jump;
  const Complex log_w = std::log(alpha - beta - imaginary * u) + std::log(alpha + beta + imaginary * u);
  if (delta == 0.0) return lambda * (_log_gamma_squared - log_w);
  const Complex z = delta * std::exp(0.5 * log_w);
  return 0.5 * lambda * (_log_gamma_squared - log_w) + (log_bessel_k(lambda, z) - z) - _log_k;
}

Complex CharacteristicExponent::jump_exponent(Complex u) const {
  const auto& jump = _contract.jump;
  switch (_contract.model) {
    case JumpModel::generalized_hyperbolic:
      return generalized_hyperbolic(u);
    case JumpModel::black_scholes:
      return 0.0;
    case JumpModel::merton:
      return jump[0] * (std::exp(imaginary * u * jump[1] - 0.5 * jump[2] * jump[2] * u * u) - 1.0);
    case JumpModel::kou:
      return jump[0] * (jump[1] * imaginary * u / (jump[2] - imaginary * u) -
                        (1.0 - jump[1]) * imaginary * u / (jump[3] + imaginary * u));
  }
  return 0.0;
}

Complex CharacteristicExponent::operator()(Complex u) const {
  return _is_dual ? primal(-u - imaginary) - (_contract.rate - _contract.dividend) : primal(u);
}

CharacteristicExponent CharacteristicExponent::dual() const {
  CharacteristicExponent dual = *this;
  dual._is_dual = !_is_dual;
  return dual;
}

Complex CharacteristicExponent::primal(Complex u) const {
  return imaginary * _drift * u - 0.5 * _contract.variance * u * u + jump_exponent(u);
}

/// Derivatives of psi at 0 by Cauchy's integral formula on a circle.
CharacteristicExponent::Cumulants CharacteristicExponent::cumulants() const {
  constexpr int points = 32;
  const double radius = 0.5 * std::min(1.0, radius_of(_contract, _is_dual));
  Complex derivatives[3] = {};  // psi^(n)(0) / n! for n = 1, 2, 4
  const int orders[3] = {1, 2, 4};
  for (int k = 0; k < points; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / points;
    const Complex value = (*this)(std::polar(radius, angle));
    for (int n = 0; n < 3; ++n)
      derivatives[n] += value * std::polar(1.0 / points, -angle * orders[n]) * std::pow(radius, -orders[n]);
  }
  return {std::imag(derivatives[0]), -2.0 * std::real(derivatives[1]), 24.0 * std::real(derivatives[2])};
}

/// The jump densities decay exponentially, Merton's as a normal density.
CharacteristicExponent::JumpRange CharacteristicExponent::jump_range() const {
  const auto& jump = _contract.jump;
  JumpRange range{0.0, 0.0};
  const double shift = _is_dual ? 1.0 : 0.0;
  switch (_contract.model) {
    case JumpModel::generalized_hyperbolic:
      range = {jump_range_digits / (jump[1] + jump[2] + shift),
               jump_range_digits / (jump[1] - jump[2] - shift)};
      break;
    case JumpModel::kou:
      range = {jump_range_digits / (jump[3] + shift), jump_range_digits / (jump[2] - shift)};
      break;
    case JumpModel::merton: {
      const double mean = jump[1] + shift * jump[2] * jump[2];
      const double deviations = std::sqrt(2.0 * jump_range_digits) * jump[2];
      range = {std::max(deviations - mean, 0.0), std::max(deviations + mean, 0.0)};
      break;
    }
    case JumpModel::black_scholes:
      break;
  }
  return _is_dual ? JumpRange{range.up, range.down} : range;
}

}  // namespace drogue::options
