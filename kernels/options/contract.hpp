#pragma once

namespace drogue::options {

/// When the holder may exercise: at any time, or at maturity only.
enum class Style : unsigned char { american, european };
enum class Type : unsigned char { put, call };

/// The law of the jumps of the logarithm of the asset's price. `Contract::jump` holds its parameters.
enum class Model : unsigned char {
  generalized_hyperbolic,  ///< lambda, alpha, beta, delta
  black_scholes,           ///< none
  merton,                  ///< intensity 1/year, mean and standard deviation of a jump
  kou,  ///< intensity 1/year, probability of a jump upwards, rates of decay upwards and downwards
};

/// One option and the exponential Levy process of its asset. Times are in years, rates a year and
/// continuously compounded, prices in money.
struct Contract {
  Model model = Model::generalized_hyperbolic;
  Style style = Style::american;
  Type type = Type::put;
  double spot = 1.0;
  double strike = 1.0;
  double rate = 0.0;
  double dividend = 0.0;
  double maturity = 1.0;
  double variance = 0.0;  ///< of the Brownian part, a year: sigma^2, not sigma
  double jump[4] = {0.0, 0.0, 0.0, 0.0};
};

/// What became of a contract.
enum class Outcome : unsigned char {
  ok,
  coarse,  ///< priced, but `error` is above the tolerance asked for
  failed,  ///< nothing of the price can be used; `Failure` says why
};

/// Why there is no price.
enum class Failure : unsigned char {
  none,
  too_large,  ///< e^{-r T}, in money, is beyond all numbers: r the rate, of a call the dividend
  no_grid,    ///< no grid reaches as far as the law does until maturity
  grown,      ///< the values grew without bound: steps are too few for the mesh, or the mesh too coarse
  stiff,      ///< they grew, and more happens until maturity than any steps follow
  overflow,   ///< what finite differences of the law and the rates are made of is beyond all numbers
  series,     ///< a Fourier integral or series is not finite
};

/// What a pricer says of a contract. Not a number where the method does not give a value.
struct Price {
  double price = 0.0;
  double error = 0.0;              ///< estimate of |price - true price|, money
  double delta = 0.0;              ///< d price / d spot
  double gamma = 0.0;              ///< d^2 price / d spot^2
  double theta = 0.0;              ///< d price / d t at fixed spot, a year
  double exercise_boundary = 0.0;  ///< the spot at which exercise becomes right at t = 0
  int mesh = 0;                    ///< intervals in space of the solve that gave the price
  int steps = 0;                   ///< its steps in time
  Outcome outcome = Outcome::ok;
  Failure failure = Failure::none;
};

}  // namespace drogue::options
