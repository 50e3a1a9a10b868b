#include "kernels/reference/gas/weno.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

namespace {

using Weights = std::array<double, 3>;

constexpr Weights ideal = {0.1, 0.6, 0.3};
constexpr double js_epsilon = 1e-6;
constexpr double small_epsilon = 1e-40;
constexpr double teno_cut = 1e-5;

double square(double x) { return x * x; }

Weights normalised(const Weights& raw) {
  const double sum = raw[0] + raw[1] + raw[2];
  return {raw[0] / sum, raw[1] / sum, raw[2] / sum};
}

Weights js_weights(const Weights& beta, double epsilon) {
  Weights raw{};
  for (std::size_t k = 0; k < 3; ++k) raw[k] = ideal[k] / square(epsilon + beta[k]);
  return normalised(raw);
}

Weights mapped_weights(const Weights& beta) {
  const Weights w = js_weights(beta, small_epsilon);
  Weights raw{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = ideal[k];
    raw[k] = w[k] * (d + d * d - 3.0 * d * w[k] + w[k] * w[k]) / (d * d + w[k] * (1.0 - 2.0 * d));
  }
  return normalised(raw);
}

Weights z_weights(const Weights& beta, int power) {
  const double tau = std::abs(beta[0] - beta[2]);
  Weights raw{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double ratio = tau / (beta[k] + small_epsilon);
    raw[k] = ideal[k] * (1.0 + (power == 2 ? square(ratio) : ratio));
  }
  return normalised(raw);
}

Weights teno_weights(const Weights& beta) {
  const double tau = std::abs(beta[0] - beta[2]);
  Weights scale{};
  for (std::size_t k = 0; k < 3; ++k) scale[k] = 1.0 + tau / (beta[k] + small_epsilon);
  // The sixth power overflows if one indicator vanishes, which gives 0/0; hence the division by the maximum.
  const double largest = *std::max_element(scale.begin(), scale.end());
  for (double& s : scale) s = square(square(s / largest) * (s / largest));
  const Weights chi = normalised(scale);
  Weights raw{};
  for (std::size_t k = 0; k < 3; ++k) raw[k] = chi[k] < teno_cut ? 0.0 : ideal[k];
  return normalised(raw);
}

}  // namespace

std::array<double, 3> smoothness(const std::array<double, 5>& f) {
  return {13.0 / 12.0 * square(f[0] - 2.0 * f[1] + f[2]) + 0.25 * square(f[0] - 4.0 * f[1] + 3.0 * f[2]),
          13.0 / 12.0 * square(f[1] - 2.0 * f[2] + f[3]) + 0.25 * square(f[1] - f[3]),
          13.0 / 12.0 * square(f[2] - 2.0 * f[3] + f[4]) + 0.25 * square(3.0 * f[2] - 4.0 * f[3] + f[4])};
}

std::array<double, 3> weno_weights(const std::array<double, 5>& f, gas::Weno scheme, int power) {
  const Weights beta = smoothness(f);
  switch (scheme) {
    case gas::Weno::js:
      return js_weights(beta, js_epsilon);
    case gas::Weno::m:
      return mapped_weights(beta);
    case gas::Weno::teno5:
      return teno_weights(beta);
    case gas::Weno::z:
      break;
  }
  return z_weights(beta, power);
}

double weno_face_value(const std::array<double, 5>& f, gas::Weno scheme, int power) {
  const Weights w = weno_weights(f, scheme, power);
  return w[0] * (2.0 * f[0] - 7.0 * f[1] + 11.0 * f[2]) / 6.0 +
         w[1] * (-f[1] + 5.0 * f[2] + 2.0 * f[3]) / 6.0 + w[2] * (2.0 * f[2] + 5.0 * f[3] - f[4]) / 6.0;
}

}  // namespace drogue::reference
