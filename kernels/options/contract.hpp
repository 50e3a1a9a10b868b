#pragma once

namespace drogue::options {

/// Exercise style: at any time until maturity, or at maturity only.
enum class Style : unsigned char { american, european };
enum class Type : unsigned char { put, call };

/// Jump distribution of the logarithm of the asset price. `Contract::jump` holds its parameters.
enum class JumpModel : unsigned char {
  generalized_hyperbolic,  ///< lambda, alpha, beta, delta (Barndorff-Nielsen 1977)
  black_scholes,           ///< no jumps, no parameters
  merton,                  ///< intensity (1/year), mean and standard deviation of a jump (Merton 1976)
  kou,                     ///< intensity (1/year), probability of an upward jump, decay rates of upward and
                           ///< downward jumps (Kou 2002)
};

/// One option and the exponential Levy process of its asset. Times in years, rates per year and continuously
/// compounded, prices in money.
struct Contract {
  JumpModel model = JumpModel::generalized_hyperbolic;
  Style style = Style::american;
  Type type = Type::put;
  double spot = 1.0;
  double strike = 1.0;
  double rate = 0.0;
  double dividend = 0.0;
  double maturity = 1.0;
  double variance = 0.0;  ///< variance of the Brownian part per year: sigma^2
  double jump[4] = {0.0, 0.0, 0.0, 0.0};
};

/// Result of pricing a contract.
enum class PriceStatus : unsigned char {
  ok,
  coarse,  ///< priced, but `error` exceeds the tolerance, which chose the mesh
  failed,  ///< no usable price; `Price::failure` states the reason
};

/// Reason for which a contract has no price.
enum class PricingFailure : unsigned char {
  none,
  discount_overflow,     ///< e^{-r T} of a put or e^{-q T} of a call, in money, exceeds the range of double
  no_grid,               ///< no grid covers the distribution of the asset at maturity
  unstable,              ///< unbounded growth: too few steps for the mesh, or too coarse a mesh
  stiff,                 ///< unbounded growth, and too many jumps until maturity for any number of steps
  coefficient_overflow,  ///< coefficients of the finite differences exceed the range of double
  fourier_not_finite,    ///< the Fourier integral or series is not finite
};

/// Price of a contract. NaN for values that the method does not compute.
struct Price {
  double price = 0.0;              ///< money
  double error = 0.0;              ///< estimate of |price - true price|, money
  double delta = 0.0;              ///< d price / d spot
  double gamma = 0.0;              ///< d^2 price / d spot^2, 1/money
  double theta = 0.0;              ///< d price / d t at fixed spot, money per year
  double exercise_boundary = 0.0;  ///< critical spot at t = 0, money: beyond it immediate exercise is optimal
  int mesh = 0;                    ///< spatial intervals of the finest solve
  int steps = 0;                   ///< time steps of the finest solve
  PriceStatus status = PriceStatus::ok;
  PricingFailure failure = PricingFailure::none;
};

}  // namespace drogue::options
