#include "kernels/options/cos/european.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace drogue::options {
namespace {

using Complex = std::complex<double>;
constexpr std::complex<double> imaginary_unit{0.0, 1.0};

/// Integrals over the contour in the strip -1 < Im u < 0.
struct Integrals {
  double value = 0.0;
  double first = 0.0, second = 0.0;  ///< derivatives by log spot
  double by_maturity = 0.0;          ///< derivative by maturity
  int nodes = 0;
};

/// Trapezoidal sums of half the step, from the sums over the even and the odd nodes.
Integrals merge(const Integrals& a, const Integrals& b) {
  return {.value = 0.5 * (a.value + b.value),
          .first = 0.5 * (a.first + b.first),
          .second = 0.5 * (a.second + b.second),
          .by_maturity = 0.5 * (a.by_maturity + b.by_maturity),
          .nodes = a.nodes + b.nodes};
}

/// Contour u(y) = i centre + scale sinh(i tilt + y), or the line u(y) = y - i/2 if it does not bend.
struct Contour {
  bool bends;
  double tilt, centre, scale, step;

  [[nodiscard]] Complex point(double y) const {
    return bends ? imaginary_unit * centre + scale * std::sinh(imaginary_unit * tilt + y) : Complex(y, -0.5);
  }
  [[nodiscard]] Complex slope(double y) const {
    return bends ? scale * std::cosh(imaginary_unit * tilt + y) : 1.0;
  }
};

constexpr double digits = 40.0;  // errors of step and truncation are exp(-digits) for a bounded integrand

/// Contour of a contract. It crosses the imaginary axis at -1/2, half-way between the poles at 0 and -i, the
/// closest singularities, and bends to the side on which exp(i u log_moneyness) decays. The integrand must
/// decay up to the angle 2 |tilt|, which is pi/4 with a Brownian part and pi/2 without. Merton's normal jumps
/// grow too fast off the real axis, so their contour does not bend.
Contour choose_contour(const Contract& c, double log_moneyness) {
  using std::numbers::pi;
  if (c.model == JumpModel::merton)
    return {.bends = false, .tilt = 0.0, .centre = 0.0, .scale = 0.0, .step = pi / digits};
  const double half_width = 0.95 * (c.variance > 0.0 ? pi / 8.0 : pi / 4.0);
  const double tilt = log_moneyness >= 0.0 ? half_width : -half_width;
  const double low = std::sin(tilt - half_width), high = std::sin(tilt + half_width);
  const double scale = 1.0 / (high - low);  // the poles lie on the edges of the strip of the quadrature
  return {.bends = true,
          .tilt = tilt,
          .centre = -scale * high,
          .scale = scale,
          .step = 2.0 * pi * half_width / digits};
}

/// Integral of exp(i u log_moneyness + T psi(u)) / (u (u + i)) du / (2 pi) by the trapezoidal rule. The
/// halves left and right of the imaginary axis are conjugate. Nodes are y = (k + offset) step, k = 0, 1, ...
Integrals integrate(const Contract& c, const CharacteristicExponent& psi, double log_moneyness,
                    const Contour& contour, double offset) {
  Integrals sums;
  int small = 0;
  constexpr int max_nodes = 4000000;
  for (; sums.nodes < max_nodes && small < 8; ++sums.nodes) {
    const double y = (sums.nodes + offset) * contour.step;
    const Complex u = contour.point(y);
    const Complex exponent = psi(u);
    const Complex value = std::exp(imaginary_unit * u * log_moneyness + c.maturity * exponent) *
                          contour.slope(y) * (contour.step / std::numbers::pi / (y == 0.0 ? 2.0 : 1.0)) /
                          (u * (u + imaginary_unit));
    sums.value += std::real(value);
    sums.first += std::real(imaginary_unit * u * value);
    sums.second += std::real(-u * u * value);
    sums.by_maturity += std::real(exponent * value);
    small = std::abs(value) * (1.0 + std::abs(u * u)) < 1e-18 || std::abs(value) < 1e-30 ? small + 1 : 0;
    if (!std::isfinite(sums.value)) break;
    // The density may have a pole, and no derivatives: the convergence of the value then ends the sum.
    if (small == 0 && std::abs(value) < 1e-17 && y > 60.0 && contour.bends) break;
  }
  return sums;
}

}  // namespace

Price european_price(const Contract& c, const CharacteristicExponent& psi) {
  const double log_moneyness = std::log(c.spot / c.strike);
  Contour contour = choose_contour(c, log_moneyness + c.maturity * psi.drift());
  Integrals sums = integrate(c, psi, log_moneyness, contour, 0.0);
  // With many jumps until maturity the integrand grows beside the contour, which enlarges the quadrature
  // error: halve the step until the value has converged.
  double change = 1.0;
  for (int halvings = 0; halvings < 8 && change > 1e-14; ++halvings) {
    const Integrals between = integrate(c, psi, log_moneyness, contour, 0.5);
    contour.step *= 0.5;
    const Integrals finer = merge(sums, between);
    change = std::abs(finer.value - sums.value);
    sums = finer;
  }
  const double bond = c.strike * std::exp(-c.rate * c.maturity);
  const double prepaid_forward = c.spot * std::exp(-c.dividend * c.maturity);
  // Between the poles the integral is that of min(prepaid_forward, bond) up to sign. The residue depends on
  // the type.
  const bool is_put = c.type == Type::put;
  Price price;
  // Rounding must not violate the no-arbitrage bound.
  const double lower_bound = std::max(is_put ? bond - prepaid_forward : prepaid_forward - bond, 0.0);
  price.price = (is_put ? bond : prepaid_forward) - bond * sums.value;
  if (price.price < lower_bound) price.price = lower_bound;
  price.delta = ((is_put ? 0.0 : prepaid_forward) - bond * sums.first) / c.spot;
  price.gamma = bond * (sums.first - sums.second) / (c.spot * c.spot);
  price.theta = bond * (sums.by_maturity - c.rate * sums.value) +
                (is_put ? c.rate * bond : c.dividend * prepaid_forward);
  price.error = 1e-13 * (bond + prepaid_forward) + bond * change;
  price.exercise_boundary = std::numeric_limits<double>::quiet_NaN();
  price.mesh = sums.nodes;
  price.steps = 1;
  return price;
}

}  // namespace drogue::options
