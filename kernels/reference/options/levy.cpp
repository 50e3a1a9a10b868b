#include "kernels/reference/options/levy.hpp"

#include <algorithm>
#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/expint.hpp>
#include <cmath>
#include <numbers>

namespace drogue::reference {
namespace {

using std::numbers::pi;

/// Integral of f(s) over the spectral measure of the jumps, for which f(s) = e^{-s|x|} gives |x| e^{-beta x}
/// g(x)
/// ([Shi], section 4.6.1).
template <class F>
double integrate_spectrum(const GeneralizedHyperbolic& jumps, const F& f) {
  const double order = std::abs(jumps.lambda);
  double sum = jumps.lambda > 0.0 ? jumps.lambda * f(jumps.alpha) : 0.0;
  if (jumps.delta == 0.0) return sum;
  // With w = sqrt(2 y) the printed integrand is 2/(pi^2 w (J^2 + Y^2)).
  const auto integrand = [&](double w) {
    const double z = jumps.delta * w, s = std::hypot(w, jumps.alpha);
    // J^2 + Y^2 is (2 order/(e z))^(2 order) up to a factor; its reciprocal is negligible beyond 1e250.
    if (z == 0.0 || !std::isfinite(s) || order * std::log(std::max(order, 1.0) / z) > 250.0) return 0.0;
    const double value = f(s);
    if (value == 0.0) return 0.0;
    if (z > 1e4) return value * jumps.delta / pi;  // pi z (J^2 + Y^2) = 2 up to 1e-8
    const double j = boost::math::cyl_bessel_j(order, z), y = boost::math::cyl_neumann(order, z);
    const double modulus = j * j + y * y;
    return std::isfinite(modulus) ? value * 2.0 / (pi * pi * w * modulus) : 0.0;
  };
  boost::math::quadrature::exp_sinh<double> rule;
  return sum + rule.integrate(integrand, 1e-9);
}

}  // namespace

double levy_density(const GeneralizedHyperbolic& jumps, double x) {
  const double size = std::abs(x);
  return integrate_spectrum(jumps, [&](double s) { return std::exp(jumps.beta * x - s * size); }) / size;
}

double levy_variance(const GeneralizedHyperbolic& jumps) {
  const double square = jumps.alpha * jumps.alpha - jumps.beta * jumps.beta;
  if (jumps.delta == 0.0) return 2.0 * jumps.lambda / square * (1.0 + 2.0 * jumps.beta * jumps.beta / square);
  const double z = jumps.delta * std::sqrt(square), k = boost::math::cyl_bessel_k(jumps.lambda, z),
               r = boost::math::cyl_bessel_k(jumps.lambda + 1.0, z) / k,
               next = boost::math::cyl_bessel_k(jumps.lambda + 2.0, z) / k;
  return jumps.delta * jumps.delta * (r / z + jumps.beta * jumps.beta / square * (next - r * r));
}

double levy_tail(const GeneralizedHyperbolic& jumps, double length, int side, int k) {
  return integrate_spectrum(jumps, [&](double s) {
    const double decay = (s - side * (jumps.beta + k)) * length;
    return decay < 700.0 ? boost::math::expint(1, decay) : 0.0;
  });
}

double levy_tail_variance(const GeneralizedHyperbolic& jumps, double length) {
  return integrate_spectrum(jumps, [&](double s) {
    double sum = 0.0;
    for (const double decay : {s - jumps.beta, s + jumps.beta})
      sum += (length + 1.0 / decay) / decay * std::exp(-decay * length);
    return sum;
  });
}

}  // namespace drogue::reference
