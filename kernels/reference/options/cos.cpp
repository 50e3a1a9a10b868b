#include "kernels/reference/options/cos.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drogue::reference {
namespace {

using Long = long double;
using LongComplex = std::complex<Long>;
constexpr Long long_pi = std::numbers::pi_v<Long>;

/// Logarithm of the characteristic function of the jumps of a year, with w = alpha^2 - (beta + i u)^2.
LongComplex jump_exponent(const LevyAsset& a, LongComplex u) {
  const LongComplex shifted = Long(a.beta) + LongComplex(0, 1) * u;
  const LongComplex w = Long(a.alpha) * a.alpha - shifted * shifted;
  const Long w0 = (Long(a.alpha) - a.beta) * (Long(a.alpha) + a.beta);
  const LongComplex power = Long(a.lambda) / 2 * (std::log(w0) - std::log(w));
  if (a.delta == 0.0) return Long(2) * power;
  const LongComplex z = Long(a.delta) * std::sqrt(w);
  const Long z0 = Long(a.delta) * std::sqrt(w0);
  return power + std::log(scaled_bessel_k(a.lambda, z)) - z - std::log(scaled_bessel_k(a.lambda, z0)) + z0;
}

}  // namespace

std::complex<long double> scaled_bessel_k(long double nu, std::complex<long double> z) {
  const Long step = 1.0L / 64;
  LongComplex sum = 0.5L;
  for (int k = 1;; ++k) {
    const Long t = step * static_cast<Long>(k);
    const LongComplex term = std::exp(-z * (std::cosh(t) - 1)) * std::cosh(nu * t);
    sum += term;
    if (std::real(z) * (std::cosh(t) - 1) > 60 + std::abs(nu) * t) return step * sum;
  }
}

std::complex<long double> characteristic_exponent(const LevyAsset& a, std::complex<long double> u) {
  const LongComplex i(0, 1);
  const LongComplex drift = Long(a.rate) - a.dividend - Long(a.variance) / 2 - jump_exponent(a, -i);
  return i * u * drift - Long(a.variance) / 2 * u * u + jump_exponent(a, u);
}

std::vector<double> bermudan_put(const LevyAsset& asset, const std::vector<double>& dates, double low,
                                 double width, int terms, int nodes, const std::vector<double>& x) {
  std::vector<LongComplex> exponent, growth(static_cast<std::size_t>(terms));
  for (int k = 0; k < terms; ++k)
    exponent.push_back(characteristic_exponent(asset, long_pi * k / width) - Long(asset.rate));
  std::vector<Long> cosine(4 * static_cast<std::size_t>(nodes));
  for (std::size_t k = 0; k < cosine.size(); ++k)
    cosine[k] = std::cos(long_pi * static_cast<Long>(k) / (2 * nodes));
  const auto cos_at = [&](int k, int m) {  // cos(k pi (m + 1/2) / nodes)
    return cosine[static_cast<std::size_t>(k) * (2 * static_cast<std::size_t>(m) + 1) % cosine.size()];
  };
  const auto sin_at = [&](int k, int m) {  // sin(k pi (m + 1/2) / nodes)
    const std::size_t period = cosine.size();
    return cosine[(static_cast<std::size_t>(k) * (2 * static_cast<std::size_t>(m) + 1) + period -
                   static_cast<std::size_t>(nodes)) %
                  period];
  };
  std::vector<Long> value(static_cast<std::size_t>(nodes));
  const auto payoff = [&](int m) {
    return std::max(1 - std::exp(Long(low) + Long(width) * (m + 0.5L) / nodes), Long(0));
  };
  for (int m = 0; m < nodes; ++m) value[static_cast<std::size_t>(m)] = payoff(m);
  std::vector<Long> coefficient(static_cast<std::size_t>(terms));
  for (std::size_t date = dates.size(); date > 0; --date) {
    const Long dt = Long(dates[date - 1]) - (date > 1 ? Long(dates[date - 2]) : Long(0));
    for (std::size_t k = 0; k < growth.size(); ++k) growth[k] = std::exp(dt * exponent[k]);
    for (int k = 0; k < terms; ++k) {
      Long sum = 0;
      for (int m = 0; m < nodes; ++m) sum += value[static_cast<std::size_t>(m)] * cos_at(k, m);
      coefficient[static_cast<std::size_t>(k)] = sum * (k == 0 ? 1 : 2) / nodes;
    }
    if (date == 1) break;
    for (int m = 0; m < nodes; ++m) {
      Long continuation = 0;
      for (int k = 0; k < terms; ++k)
        continuation += coefficient[static_cast<std::size_t>(k)] *
                        (std::real(growth[static_cast<std::size_t>(k)]) * cos_at(k, m) -
                         std::imag(growth[static_cast<std::size_t>(k)]) * sin_at(k, m));
      value[static_cast<std::size_t>(m)] = std::max(continuation, payoff(m));
    }
  }
  std::vector<double> values;
  for (const double at : x) {
    Long sum = 0;
    for (int k = 0; k < terms; ++k)
      sum += coefficient[static_cast<std::size_t>(k)] *
             std::real(growth[static_cast<std::size_t>(k)] *
                       std::exp(LongComplex(0, long_pi * k * (Long(at) - low) / width)));
    values.push_back(static_cast<double>(sum));
  }
  return values;
}

}  // namespace drogue::reference
