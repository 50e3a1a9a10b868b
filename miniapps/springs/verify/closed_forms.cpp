#include "miniapps/springs/verify/closed_forms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace drogue::springs_app {
namespace {

/// Bisects a sign change of f between a and b to the last bit.
double bisect(const std::function<double(double)>& f, double a, double b) {
  const bool rises = f(b) > 0.0;
  for (double middle = 0.5 * (a + b); middle > a && middle < b; middle = 0.5 * (a + b))
    ((f(middle) > 0.0) == rises ? b : a) = middle;
  return 0.5 * (a + b);
}

/// n and its slope at rho = 1, and the integral of rho / n, from n(0) = c: Hencky's equation
/// rho n'' + 3 n' = -rho / (8 n^2), n = N / (E q^2 a^2)^(1/3), by Runge and Kutta.
struct HenckyEnd {
  double n, slope, integral;
};

HenckyEnd hencky_end(double c) {
  constexpr int steps = 2000;
  const double h = 1.0 / steps;
  HenckyEnd now{c, 0.0, 0.0};
  const auto rate = [](double rho, const HenckyEnd& y) -> HenckyEnd {
    // At the centre n' / rho is n'', a quarter of the right-hand side each.
    const double source = -1.0 / (8.0 * y.n * y.n);
    return {y.slope, rho > 0.0 ? source - 3.0 * y.slope / rho : 0.25 * source, rho / y.n};
  };
  const auto moved = [](const HenckyEnd& y, double step, const HenckyEnd& k) -> HenckyEnd {
    return {y.n + step * k.n, y.slope + step * k.slope, y.integral + step * k.integral};
  };
  for (int i = 0; i < steps; ++i) {
    const double rho = i * h;
    const HenckyEnd k1 = rate(rho, now), k2 = rate(rho + 0.5 * h, moved(now, 0.5 * h, k1)),
                    k3 = rate(rho + 0.5 * h, moved(now, 0.5 * h, k2)), k4 = rate(rho + h, moved(now, h, k3));
    for (const auto& [weight, k] : {std::pair{1.0, k1}, {2.0, k2}, {2.0, k3}, {1.0, k4}})
      now = moved(now, weight * h / 6.0, k);
  }
  return now;
}

}  // namespace

double bessel_zero(int m, int n) {
  // Zeros of one function are more than 3 apart, and none is below m.
  constexpr double step = 0.5;
  double low = std::max(m * 1.0, 1.0);
  for (int found = 0;; low += step) {
    const bool change = std::signbit(::jn(m, low)) != std::signbit(::jn(m, low + step));
    if (change && ++found == n) break;
  }
  return bisect([m](double x) { return ::jn(m, x); }, low, low + step);
}

double drum_tension(const fabric::Material& material, double strain) {
  const double plane = material.membrane_modulus / (1.0 - material.poisson);
  // The second Piola-Kirchhoff stress: strain of Green, or nominal stress over stretch.
  switch (material.model) {
    case fabric::Model::biquadratic:
      return plane * (strain + 0.5 * strain * strain);
    case fabric::Model::linear_vector:
    case fabric::Model::edge:
    case fabric::Model::quadratic:
      return plane * strain / (1.0 + strain);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double nominal_stress_factor(fabric::Model model, double strain) {
  switch (model) {
    case fabric::Model::biquadratic:
      return (1.0 + strain) * (1.0 + 0.5 * strain);
    case fabric::Model::linear_vector:
    case fabric::Model::edge:
    case fabric::Model::quadratic:
      return 1.0;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double drum_frequency(const fabric::Material& material, double area_density, double radius, double strain,
                      int diameters, int circles) {
  const double speed = std::sqrt(drum_tension(material, strain) / area_density);
  return bessel_zero(diameters, circles) / radius * speed / (2.0 * std::numbers::pi);
}

double string_frequency(double axial_stiffness, double line_density, double length, double payload, int n) {
  const double speed = std::sqrt(axial_stiffness / line_density);
  // Without payload the tangent is infinite. With one the n-th root lies in the first half of the n-th
  // interval of pi from 0.
  const double low = (n - 1) * std::numbers::pi, high = low + 0.5 * std::numbers::pi;
  const double mass = line_density * length;
  const double phase =
      payload > 0.0
          ? bisect([&](double z) { return payload * z * std::sin(z) - mass * std::cos(z); }, low, high)
          : high;
  return phase / length * speed / (2.0 * std::numbers::pi);
}

double hanging_stretch(double axial_stiffness, double weight, double length, double payload) {
  return (payload + 0.5 * weight * length) * length / axial_stiffness;
}

Hencky hencky(double poisson) {
  const double centre = bisect(
      [poisson](double c) {
        const HenckyEnd end = hencky_end(c);
        return end.slope + (1.0 - poisson) * end.n;
      },
      0.355, 1.0);
  return {0.5 * hencky_end(centre).integral, centre};
}

std::vector<CatenaryPoint> catenary_points(const Catenary& c, const std::vector<double>& arc) {
  // H is the horizontal tension, V the vertical one at the first end, downwards along the string.
  const auto point = [&c](double H, double V, double s) -> CatenaryPoint {
    const double below = V - c.weight * s;
    return {H * s / c.axial_stiffness + H / c.weight * (std::asinh(V / H) - std::asinh(below / H)),
            (V * s - 0.5 * c.weight * s * s) / c.axial_stiffness +
                (std::hypot(H, V) - std::hypot(H, below)) / c.weight};
  };
  // For a given H the drop grows with V, and with it as it must be the span grows with H.
  const double total = c.weight * c.length;
  const double most = total + 10.0 * c.axial_stiffness;
  const auto vertical = [&](double H) {
    return bisect([&](double V) { return point(H, V, c.length).down - c.drop; }, -most, most + total);
  };
  const auto excess = [&](double H) { return point(H, vertical(H), c.length).along - c.span; };
  const double least = 1e-9 * total;
  if (!(excess(least) < 0.0 && excess(most) > 0.0)) return {};
  const double H = bisect(excess, least, most), V = vertical(H);
  std::vector<CatenaryPoint> points;
  for (const double s : arc) points.push_back(point(H, V, s));
  return points;
}

}  // namespace drogue::springs_app
