#include "kernels/options/cos/european.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace drogue::options {
namespace {

using Complex = std::complex<double>;
constexpr std::complex<double> unit_up{0.0, 1.0};

/// Of integrals over the contour in the strip -1 < Im u < 0: of the value and its derivatives by log spot
/// (twice) and maturity.
struct Integrals {
  double value = 0.0, first = 0.0, second = 0.0, by_maturity = 0.0;
  int nodes = 0;
};

/// The sums over the nodes of both, of half the step.
Integrals mean(const Integrals& a, const Integrals& b) {
  return {0.5 * (a.value + b.value), 0.5 * (a.first + b.first), 0.5 * (a.second + b.second),
          0.5 * (a.by_maturity + b.by_maturity), a.nodes + b.nodes};
}

/// Where the integrand is taken: u = i centre + scale sinh(i tilt + y), or, if it may not bend, u = y - i/2.
struct Contour {
  bool bends;
  double tilt, centre, scale, step;

  [[nodiscard]] Complex point(double y) const {
    return bends ? unit_up * centre + scale * std::sinh(unit_up * tilt + y) : Complex(y, -0.5);
  }
  [[nodiscard]] Complex slope(double y) const { return bends ? scale * std::cosh(unit_up * tilt + y) : 1.0; }
};

constexpr double digits = 40.0;  // of exp(-digits) are the errors of step and cut, if nothing grows

/// The contour crosses the imaginary axis at -1/2, half-way between the poles at 0 and -1: no other
/// singularity is ever that close. It bends to the side on which exp(i u log_moneyness) falls. Up to the
/// angle 2 |tilt| the integrand must be small: pi/4 with a Brownian part, else pi/2. A normal law of jumps
/// grows there faster than anything falls.
Contour contour_of(const Contract& c, double log_moneyness) {
  using std::numbers::pi;
  if (c.model == Model::merton) return {false, 0.0, 0.0, 0.0, pi / digits};
  const double half_width = 0.95 * (c.variance > 0.0 ? pi / 8.0 : pi / 4.0);
  const double tilt = log_moneyness >= 0.0 ? half_width : -half_width;
  const double low = std::sin(tilt - half_width), high = std::sin(tilt + half_width);
  const double scale = 1.0 / (high - low);  // the poles stand at the edges of what the step sees
  return {true, tilt, -scale * high, scale, 2.0 * pi * half_width / digits};
}

/// integral of exp(i u log_moneyness + T psi(u)) / (u (u + unit_up)) du / (2 pi), by the trapezoid rule. The
/// halves right and left of the imaginary axis are conjugate. Nodes lie `offset` steps beside those from 0
/// on.
Integrals integrate(const Contract& c, const Exponent& psi, double log_moneyness, const Contour& contour,
                    double offset) {
  Integrals sums;
  int small = 0;
  constexpr int most_nodes = 4000000;
  for (; sums.nodes < most_nodes && small < 8; ++sums.nodes) {
    const double y = (sums.nodes + offset) * contour.step;
    const Complex u = contour.point(y);
    const Complex exponent = psi(u);
    const Complex value = std::exp(unit_up * u * log_moneyness + c.maturity * exponent) * contour.slope(y) *
                          (contour.step / std::numbers::pi / (y == 0.0 ? 2.0 : 1.0)) / (u * (u + unit_up));
    sums.value += std::real(value);
    sums.first += std::real(unit_up * u * value);
    sums.second += std::real(-u * u * value);
    sums.by_maturity += std::real(exponent * value);
    small = std::abs(value) * (1.0 + std::abs(u * u)) < 1e-18 || std::abs(value) < 1e-30 ? small + 1 : 0;
    if (!std::isfinite(sums.value)) break;
    // Derivatives may not exist (a density with a pole): then the value decides when to end.
    if (small == 0 && std::abs(value) < 1e-17 && y > 60.0 && contour.bends) break;
  }
  return sums;
}

}  // namespace

Price european_price(const Contract& c, const Exponent& psi) {
  const double log_moneyness = std::log(c.spot / c.strike);
  Contour contour = contour_of(c, log_moneyness + c.maturity * psi.drift());
  Integrals sums = integrate(c, psi, log_moneyness, contour, 0.0);
  // Laws of many jumps grow beside the contour, where the step looks: it is halved until that does not show.
  double change = 1.0;
  for (int halvings = 0; halvings < 8 && change > 1e-14; ++halvings) {
    const Integrals between = integrate(c, psi, log_moneyness, contour, 0.5);
    contour.step *= 0.5;
    const Integrals finer = mean(sums, between);
    change = std::abs(finer.value - sums.value);
    sums = finer;
  }
  const double bond = c.strike * std::exp(-c.rate * c.maturity);
  const double share = c.spot * std::exp(-c.dividend * c.maturity);
  // Between the poles the integral is min(share, strike) less a sign: add the residue that the type asks for.
  const bool is_put = c.type == Type::put;
  Price price;
  // Rounding must not take a price below what no law allows.
  const double least = std::max(is_put ? bond - share : share - bond, 0.0);
  price.price = (is_put ? bond : share) - bond * sums.value;
  if (price.price < least) price.price = least;
  price.delta = ((is_put ? 0.0 : share) - bond * sums.first) / c.spot;
  price.gamma = bond * (sums.first - sums.second) / (c.spot * c.spot);
  price.theta =
      bond * (sums.by_maturity - c.rate * sums.value) + (is_put ? c.rate * bond : c.dividend * share);
  price.error = 1e-13 * (bond + share) + bond * change;
  price.exercise_boundary = std::numeric_limits<double>::quiet_NaN();
  price.mesh = sums.nodes;
  price.steps = 1;
  return price;
}

}  // namespace drogue::options
