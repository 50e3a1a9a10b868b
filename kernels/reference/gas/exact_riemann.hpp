#pragma once

#include <optional>

#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Exact solution of the Riemann problem of the Euler equations for an ideal gas (Toro 2009, chapter 4). It
/// includes vacuum: a state of density 0, or two states that recede fast enough to create one.
class ExactRiemann {
 public:
  /// Throws `std::invalid_argument` unless gamma > 1 and each state is a vacuum (rho = p = 0) or has rho, p >
  /// 0.
  ExactRiemann(const Primitive& left, const Primitive& right, double gamma);

  /// State on the ray x/t = `speed`, m/s. In a vacuum rho = p = 0 and u = speed. Does not throw.
  [[nodiscard]] Primitive sample(double speed) const;

  [[nodiscard]] bool has_vacuum() const { return _vacuum; }
  [[nodiscard]] double star_pressure() const { return _p; }
  [[nodiscard]] double star_velocity() const { return _u; }
  [[nodiscard]] double star_density_left() const;
  [[nodiscard]] double star_density_right() const;

  /// Speed of the wave that enters the left or the right state, m/s, from left to right; nothing if it has no
  /// strength, or if that state is a vacuum.
  [[nodiscard]] std::optional<double> left_wave() const;
  [[nodiscard]] std::optional<double> right_wave() const;

 private:
  [[nodiscard]] std::optional<double> outer_wave(const Primitive& side) const;
  [[nodiscard]] Primitive sample_side(const Primitive& side, double speed) const;

  Primitive _left;
  Primitive _right;
  double _gamma;
  bool _vacuum = false;
  double _p = 0.0;
  double _u = 0.0;
};

}  // namespace drogue::reference
