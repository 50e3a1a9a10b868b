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

/// The integral of f(s) over the spectral measure of the law: |x| e^{-beta x} g(x) is that of e^{-s|x|}.
template <class F>
double over_spectrum(const Hyperbolic& law, const F& f) {
  const double order = std::abs(law.lambda);
  double sum = law.lambda > 0.0 ? law.lambda * f(law.alpha) : 0.0;
  if (law.delta == 0.0) return sum;
  // With w = sqrt(2y) the printed integrand is 2/(pi^2 w (J^2 + Y^2)).
  const auto integrand = [&](double w) {
    const double z = law.delta * w, s = std::hypot(w, law.alpha);
    // (2 order/(e z))^(2 order) is J^2 + Y^2 up to a factor: what follows from beyond 1e250 is nothing.
    if (z == 0.0 || !std::isfinite(s) || order * std::log(std::max(order, 1.0) / z) > 250.0) return 0.0;
    const double value = f(s);
    if (value == 0.0) return 0.0;
    if (z > 1e4) return value * law.delta / pi;  // there pi z (J^2 + Y^2) = 2 to 1e-8
    const double j = boost::math::cyl_bessel_j(order, z), y = boost::math::cyl_neumann(order, z);
    const double modulus = j * j + y * y;
    return std::isfinite(modulus) ? value * 2.0 / (pi * pi * w * modulus) : 0.0;
  };
  boost::math::quadrature::exp_sinh<double> rule;
  return sum + rule.integrate(integrand, 1e-9);
}

}  // namespace

double levy_density(const Hyperbolic& law, double x) {
  const double size = std::abs(x);
  return over_spectrum(law, [&](double s) { return std::exp(law.beta * x - s * size); }) / size;
}

double levy_variance(const Hyperbolic& law) {
  const double square = law.alpha * law.alpha - law.beta * law.beta;
  if (law.delta == 0.0) return 2.0 * law.lambda / square * (1.0 + 2.0 * law.beta * law.beta / square);
  const double z = law.delta * std::sqrt(square), k = boost::math::cyl_bessel_k(law.lambda, z),
               r = boost::math::cyl_bessel_k(law.lambda + 1.0, z) / k,
               next = boost::math::cyl_bessel_k(law.lambda + 2.0, z) / k;
  return law.delta * law.delta * (r / z + law.beta * law.beta / square * (next - r * r));
}

double levy_tail(const Hyperbolic& law, double length, int side, int k) {
  return over_spectrum(law, [&](double s) {
    const double decay = (s - side * (law.beta + k)) * length;
    return decay < 700.0 ? boost::math::expint(1, decay) : 0.0;
  });
}

double levy_tail_variance(const Hyperbolic& law, double length) {
  return over_spectrum(law, [&](double s) {
    double sum = 0.0;
    for (const double decay : {s - law.beta, s + law.beta})
      sum += (length + 1.0 / decay) / decay * std::exp(-decay * length);
    return sum;
  });
}

}  // namespace drogue::reference
