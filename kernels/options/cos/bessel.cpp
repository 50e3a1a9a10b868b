#include "kernels/options/cos/bessel.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace drogue::options {
namespace {

using Complex = std::complex<double>;

/// log(e^z K_mu(z)) and K_(mu+1)(z) / K_mu(z) for |mu| <= 1/2.
struct LowOrder {
  Complex log_k;
  Complex ratio;
};

/// Taylor coefficients of 1 / Gamma(1 + x) (Abramowitz and Stegun, eq. (6.1.34)).
constexpr double reciprocal_gamma[] = {
    1.0,
    0.5772156649015329,
    -0.6558780715202538,
    -0.0420026350340952,
    0.1665386113822915,
    -0.0421977345555443,
    -0.0096219715278770,
    0.0072189432466630,
    -0.0011651675918591,
    -0.0002152416741149,
    0.0001280502823882,
    -0.0000201348547807,
    -0.0000012504934821,
    0.0000011330272320,
    -0.0000002056338417,
    0.0000000061160950,
    0.0000000050020075,
    -0.0000000011812746,
    0.0000000001043427,
    0.0000000000077823,
    -0.0000000000036968,
    0.0000000000005100,
    -0.0000000000000206,
    -0.0000000000000054,
    0.0000000000000014,
};

/// Temme's series for |z| < 2 (Temme 1975).
LowOrder temme_series(double mu, Complex z) {
  double gamma1 = 0.0, gamma2 = 0.0;  // odd and even parts of 1 / Gamma(1 - mu)
  double power = 1.0;
  for (int k = 0; k < 25; k += 2) {
    gamma2 += reciprocal_gamma[k] * power;
    if (k + 1 < 25) gamma1 -= reciprocal_gamma[k + 1] * power;
    power *= mu * mu;
  }
  const Complex log_2z = std::log(2.0 / z);
  const Complex e = mu * log_2z;
  const double angle = std::numbers::pi * mu;
  const double reflection = mu == 0.0 ? 1.0 : angle / std::sin(angle);
  const Complex sinhc = std::abs(e) < 1e-4 ? 1.0 + e * e / 6.0 : std::sinh(e) / e;
  Complex f = reflection * (gamma1 * std::cosh(e) + gamma2 * sinhc * log_2z);
  Complex p = 0.5 * std::exp(e) / (gamma2 - mu * gamma1);
  Complex q = 0.5 * std::exp(-e) / (gamma2 + mu * gamma1);
  Complex sum = f, sum1 = p, c = 1.0;
  for (int k = 1; k < 100; ++k) {
    f = (static_cast<double>(k) * f + p + q) / (k * k - mu * mu);
    c *= 0.25 * z * z / static_cast<double>(k);
    p /= k - mu;
    q /= k + mu;
    sum += c * f;
    const Complex term = c * (p - static_cast<double>(k) * f);
    sum1 += term;
    if (std::abs(term) < 1e-17 * std::abs(sum1)) break;
  }
  return {std::log(sum) + z, sum1 * 2.0 / (z * sum)};
}

/// Temme's continued fraction for |z| >= 2 by Steed's method (Press et al. 2007, section 6.6).
LowOrder continued_fraction(double mu, Complex z) {
  const double a1 = 0.25 - mu * mu;
  Complex b = 2.0 * (1.0 + z);
  Complex d = 1.0 / b, h = d, step = d;
  Complex q1 = 0.0, q2 = 1.0, q = a1;
  double a = -a1, c = a1;
  Complex s = 1.0 + q * step;
  for (int k = 2; k < 500; ++k) {
    a -= 2.0 * (k - 1);
    c = -a * c / k;
    const Complex next = (q1 - b * q2) / a;
    q1 = q2;
    q2 = next;
    q += c * next;
    b += 2.0;
    d = 1.0 / (b + a * d);
    step *= b * d - 1.0;
    h += step;
    const Complex term = q * step;
    s += term;
    if (std::abs(term) < 1e-17 * std::abs(s)) break;
  }
  return {0.5 * std::log(std::numbers::pi / (2.0 * z)) - std::log(s), (mu + z + 0.5 - a1 * h) / z};
}

}  // namespace

std::complex<double> log_bessel_k(double nu, std::complex<double> z) {
  nu = std::abs(nu);
  if (!(nu <= 1000.0)) return std::numeric_limits<double>::quiet_NaN();
  const double whole = std::floor(nu + 0.5);
  const double mu = nu - whole;
  auto [log_k, ratio] = std::abs(z) < 2.0 ? temme_series(mu, z) : continued_fraction(mu, z);
  for (double k = 1.0; k <= whole; ++k) {
    log_k += std::log(ratio);
    ratio = 1.0 / ratio + 2.0 * (mu + k) / z;
  }
  return log_k;
}

}  // namespace drogue::options
