#include "kernels/reference/gas/exact_riemann.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace drogue::reference {

namespace {

double speed_of_sound(const Primitive& w, double gamma) { return w.rho > 0.0 ? sound_speed(w, gamma) : 0.0; }

void check(const Primitive& w) {
  const bool vacuum = w.rho == 0.0 && w.p == 0.0;
  const bool gas = w.rho > 0.0 && w.p > 0.0;
  if (!(vacuum || gas) || !std::isfinite(w.rho + w.u + w.p))
    throw std::invalid_argument("a Riemann state needs positive density and pressure, or neither");
}

struct ValueAndSlope {
  double value;
  double slope;
};

/// Velocity change across the wave between a side and pressure p (Toro 2009, eqs. 4.6, 4.7, 4.37).
ValueAndSlope wave(const Primitive& side, double p, double gamma) {
  if (p > side.p) {  // shock
    const double A = 2.0 / ((gamma + 1.0) * side.rho);
    const double B = (gamma - 1.0) / (gamma + 1.0) * side.p;
    const double root = std::sqrt(A / (p + B));
    return {(p - side.p) * root, root * (1.0 - 0.5 * (p - side.p) / (p + B))};
  }
  const double c = sound_speed(side, gamma);
  const double ratio = p / side.p;
  return {2.0 * c / (gamma - 1.0) * (std::pow(ratio, (gamma - 1.0) / (2.0 * gamma)) - 1.0),
          std::pow(ratio, -(gamma + 1.0) / (2.0 * gamma)) / (side.rho * c)};
}

/// Pressure between the waves if both are rarefactions; otherwise an upper bound for gamma <= 5/3.
double two_rarefaction_pressure(const Primitive& l, const Primitive& r, double gamma) {
  const double z = (gamma - 1.0) / (2.0 * gamma);
  const double cl = sound_speed(l, gamma);
  const double cr = sound_speed(r, gamma);
  // Pressures are scaled by the larger one, so that a pressure ratio of 1e300 does not overflow.
  const double scale = std::max(l.p, r.p);
  const double numerator = cl + cr - 0.5 * (gamma - 1.0) * (r.u - l.u);
  const double denominator = cl / std::pow(l.p / scale, z) + cr / std::pow(r.p / scale, z);
  return scale * std::pow(numerator / denominator, 1.0 / z);
}

/// Root of the increasing concave function wave(left) + wave(right) + velocity difference: Newton's method
/// within a bracket, with bisection if an iterate leaves it.
double solve_pressure(const Primitive& l, const Primitive& r, double gamma) {
  double low = 0.0;
  // Beyond pressure ratios of 1e308 that is 0, which no factor raises.
  double high = std::max(two_rarefaction_pressure(l, r, gamma), std::numeric_limits<double>::min());
  const auto f = [&](double p) {
    const ValueAndSlope a = wave(l, p, gamma);
    const ValueAndSlope b = wave(r, p, gamma);
    return ValueAndSlope{a.value + b.value + (r.u - l.u), a.slope + b.slope};
  };
  while (f(high).value < 0.0) high *= 2.0;
  double p = high;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const ValueAndSlope at = f(p);
    (at.value > 0.0 ? high : low) = p;
    double next = p - at.value / at.slope;
    if (!(next > low && next < high)) next = low > 0.0 ? std::sqrt(low) * std::sqrt(high) : 1e-3 * high;
    if (std::abs(next - p) <= 1e-15 * p) return next;
    p = next;
  }
  return p;
}

double star_density(const Primitive& side, double p, double gamma) {
  const double ratio = p / side.p;
  if (ratio <= 1.0) return side.rho * std::pow(ratio, 1.0 / gamma);
  const double mu = (gamma - 1.0) / (gamma + 1.0);
  return side.rho * (ratio + mu) / (mu * ratio + 1.0);
}

/// Speed of the left shock that compresses `side` to pressure p.
double shock_speed(const Primitive& side, double p, double gamma) {
  return side.u - sound_speed(side, gamma) *
                      std::sqrt((gamma + 1.0) / (2.0 * gamma) * (p / side.p) + (gamma - 1.0) / (2.0 * gamma));
}

/// State inside a left rarefaction on the ray `speed`.
Primitive inside_fan(const Primitive& side, double c, double speed, double gamma) {
  const double local =
      2.0 / (gamma + 1.0) * c + (gamma - 1.0) / (gamma + 1.0) * (side.u - speed);  // speed of sound there
  const double rho = side.rho * std::pow(local / c, 2.0 / (gamma - 1.0));
  return {rho, speed + local, side.p * std::pow(local / c, 2.0 * gamma / (gamma - 1.0))};
}

}  // namespace

ExactRiemann::ExactRiemann(const Primitive& left, const Primitive& right, double gamma)
    : _left(left), _right(right), _gamma(gamma) {
  if (!(gamma > 1.0)) throw std::invalid_argument("gamma must exceed 1");
  check(left);
  check(right);
  const double escape = 2.0 / (gamma - 1.0) * (speed_of_sound(left, gamma) + speed_of_sound(right, gamma));
  _vacuum = left.rho == 0.0 || right.rho == 0.0 || right.u - left.u >= escape;
  if (_vacuum) return;
  _p = solve_pressure(left, right, gamma);
  _u = 0.5 * (left.u + right.u) + 0.5 * (wave(right, _p, gamma).value - wave(left, _p, gamma).value);
}

double ExactRiemann::star_density_left() const { return _vacuum ? 0.0 : star_density(_left, _p, _gamma); }

double ExactRiemann::star_density_right() const { return _vacuum ? 0.0 : star_density(_right, _p, _gamma); }

/// Speed of the outermost left wave. `side` is the left state or the mirror image of the right one.
std::optional<double> ExactRiemann::outer_wave(const Primitive& side) const {
  constexpr double rounding = 1e-12;
  if (side.rho == 0.0 || (!_vacuum && std::abs(_p - side.p) <= rounding * side.p)) return std::nullopt;
  return !_vacuum && _p > side.p ? shock_speed(side, _p, _gamma) : side.u - sound_speed(side, _gamma);
}

std::optional<double> ExactRiemann::left_wave() const { return outer_wave(_left); }

std::optional<double> ExactRiemann::right_wave() const {
  const std::optional<double> image = outer_wave({_right.rho, -_right.u, _right.p});
  return image ? std::optional(-*image) : std::nullopt;
}

Primitive ExactRiemann::sample(double speed) const {
  if (_vacuum) {
    const double left_front = _left.u + 2.0 / (_gamma - 1.0) * speed_of_sound(_left, _gamma);
    const double right_front = _right.u - 2.0 / (_gamma - 1.0) * speed_of_sound(_right, _gamma);
    const bool beyond_left = _left.rho == 0.0 || speed >= left_front;
    const bool beyond_right = _right.rho == 0.0 || speed <= right_front;
    if (beyond_left && beyond_right) return {0.0, speed, 0.0};
    if (!beyond_left) return sample_side(_left, speed);
  } else if (speed < _u) {  // at the contact itself the right state, as in the initial state at x0
    return sample_side(_left, speed);
  }
  // The right side is the left side of the mirror image.
  const Primitive image = sample_side({_right.rho, -_right.u, _right.p}, -speed);
  return {image.rho, -image.u, image.p};
}

/// State left of the contact or vacuum. `side` is the left state or the mirror image of the right one.
Primitive ExactRiemann::sample_side(const Primitive& side, double speed) const {
  const double c = sound_speed(side, _gamma);
  if (!_vacuum && _p > side.p) {
    if (speed <= shock_speed(side, _p, _gamma)) return side;
    return {star_density(side, _p, _gamma), side.u - wave(side, _p, _gamma).value, _p};
  }
  if (speed <= side.u - c) return side;
  if (!_vacuum) {
    const double rho = star_density(side, _p, _gamma);
    const double u = side.u - wave(side, _p, _gamma).value;
    if (speed >= u - sound_speed({rho, u, _p}, _gamma)) return {rho, u, _p};
  }
  return inside_fan(side, c, speed, _gamma);
}

}  // namespace drogue::reference
