#include "kernels/options/contract_check.hpp"

#include <cmath>

namespace drogue::options {
namespace {

struct Condition {
  bool holds;
  std::string_view clause;
};

template <int count>
std::string_view first_violated(const Condition (&conditions)[count]) {
  for (const Condition& condition : conditions)
    if (!condition.holds) return condition.clause;
  return {};
}

std::string_view violated_by_generalized_hyperbolic(const Contract& c) {
  const double lambda = c.jump[0], alpha = c.jump[1], beta = c.jump[2], delta = c.jump[3];
  return first_violated({
      {std::abs(lambda) < 128.0, "lambda must lie between -128 and 128"},
      {std::isfinite(alpha) && alpha > 0.0, "alpha must be finite and > 0"},
      {alpha <= 1e100, "alpha must not be above 1e100"},
      {std::isfinite(beta), "beta must be finite"},
      {std::isfinite(delta) && delta >= 0.0, "delta must be finite and >= 0"},
      {std::abs(beta) < alpha, "|beta| < alpha must hold, else the jumps have no density"},
      {std::abs(beta + 1.0) < alpha, "|beta+1| < alpha must hold, else the asset has no mean"},
      {delta > 0.0 || lambda > 0.0, "delta = 0 needs lambda > 0, the variance gamma process"},
  });
}

std::string_view violated_by_merton(const Contract& c) {
  const double intensity = c.jump[0], mean = c.jump[1], deviation = c.jump[2];
  return first_violated({
      {c.variance > 0.0,
       "variance must be > 0 for this model, whose jumps alone leave the price unchanged between them"},
      {std::isfinite(intensity) && intensity >= 0.0, "intensity must be finite and >= 0"},
      {std::isfinite(mean), "jump_mean must be finite"},
      {std::isfinite(deviation) && deviation >= 0.0, "jump_deviation must be finite and >= 0"},
  });
}

std::string_view violated_by_kou(const Contract& c) {
  const double intensity = c.jump[0], up = c.jump[1], up_rate = c.jump[2], down_rate = c.jump[3];
  return first_violated({
      {c.variance > 0.0,
       "variance must be > 0 for this model, whose jumps alone leave the price unchanged between them"},
      {std::isfinite(intensity) && intensity >= 0.0, "intensity must be finite and >= 0"},
      {up >= 0.0 && up <= 1.0, "up_probability must lie in 0 .. 1"},
      {std::isfinite(up_rate) && up_rate > 1.0, "up_rate must be finite and > 1, else the asset has no mean"},
      {std::isfinite(down_rate) && down_rate > 0.0, "down_rate must be finite and > 0"},
  });
}

/// True for amounts of money for which all Greeks stay within the range of double.
bool is_money(double x) { return x >= 1e-100 && x <= 1e100; }

}  // namespace

std::string_view violated_condition(const Contract& c) {
  const std::string_view common = first_violated({
      {std::isfinite(c.spot) && c.spot > 0.0, "spot must be finite and > 0"},
      {std::isfinite(c.strike) && c.strike > 0.0, "strike must be finite and > 0"},
      {is_money(c.spot), "spot must lie between 1e-100 and 1e100"},
      {is_money(c.strike), "strike must lie between 1e-100 and 1e100"},
      {c.spot <= 1e20 * c.strike && c.strike <= 1e20 * c.spot, "spot/strike must lie between 1e-20 and 1e20"},
      {std::isfinite(c.rate), "rate must be finite"},
      {std::isfinite(c.dividend), "dividend must be finite"},
      {std::isfinite(c.maturity) && c.maturity > 0.0, "maturity must be finite and > 0"},
      {std::isfinite(c.variance) && c.variance >= 0.0, "variance must be finite and >= 0"},
  });
  if (!common.empty()) return common;
  switch (c.model) {
    case JumpModel::generalized_hyperbolic:
      return violated_by_generalized_hyperbolic(c);
    case JumpModel::black_scholes:
      return first_violated({{c.variance > 0.0, "variance must be > 0 where there are no jumps"}});
    case JumpModel::merton:
      return violated_by_merton(c);
    case JumpModel::kou:
      return violated_by_kou(c);
  }
  return "model must be one that is known";
}

}  // namespace drogue::options
