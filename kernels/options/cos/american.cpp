#include "kernels/options/cos/american.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace drogue::options {
namespace {

/// Extrapolations of a quantity over the levels: with all four, the three finest, the two finest.
struct Extrapolated {
  double best, second, third;
};

template <class Member>
Extrapolated extrapolate(const BermudanValue* v, Member member) {
  const double v1 = v[0].*member, v2 = v[1].*member, v4 = v[2].*member, v8 = v[3].*member;
  return {(64.0 * v8 - 56.0 * v4 + 14.0 * v2 - v1) / 21.0, (8.0 * v8 - 6.0 * v4 + v2) / 3.0, 2.0 * v8 - v4};
}

}  // namespace

AmericanPut::AmericanPut(const Contract& c)
    : x(std::log(c.type == Type::put ? c.spot / c.strike : c.strike / c.spot)),
      rate(c.type == Type::put ? c.rate : c.dividend),
      dividend(c.type == Type::put ? c.dividend : c.rate),
      psi(c.type == Type::put ? Exponent(c) : Exponent(c).dual()) {}

void AmericanPut::prepare(double expiry, int dates, double tolerance) {
  const double enough = std::log(10.0 + 10.0 / tolerance);
  const double maturity = rate * expiry > enough ? enough / rate : expiry;
  beyond = maturity < expiry ? std::exp(-enough) : 0.0;
  const Exponent::Cumulants c = psi.cumulants();
  // A year's wait costs at most what exercise earns in it. Where that is all there is to earn between two
  // dates of the coarsest level, or the drift carries the spot by more than a deviation from one to the
  // next, values of all levels may agree that hardly anything is exercised.
  const double interval = maturity / dates, earned = std::max(rate, rate - dividend) * interval;
  const bool too_few = earned > 1.0 || c.mean * c.mean * interval > c.second;
  between =
      too_few ? -std::expm1(-earned / (1 << (levels - 1))) * std::exp(std::max(-rate * maturity, 0.0)) : 0.0;
  const Exponent::Reach reach = psi.reach();
  constexpr double deviations = 12.0;
  // Heavier tails than this leaves room for are folded back by the cosines.
  constexpr double deepest = 100.0;
  const double spread =
      deviations * std::sqrt(c.second * maturity + std::sqrt(std::abs(c.fourth) * maturity));
  const double shift = c.mean * maturity;
  const double low =
      std::min(x, 0.0) - std::min(std::max(spread, reach.down) + std::max(-shift, 0.0), deepest);
  const double high = std::max(x, 0.0) + std::min(std::max(spread, reach.up) + std::max(shift, 0.0), deepest);
  const double width = high - low;
  folded = std::exp(-Exponent::reach_digits * deepest / std::max(reach.down, 1.0));

  const double dt = maturity / (dates << (levels - 1));
  const auto decay = [&](int log_terms) {
    return std::exp(dt * std::real(psi(std::numbers::pi / width * (1 << log_terms))));
  };
  constexpr double negligible = 1e-10;
  int log_terms = 6;
  while (log_terms < most_log_terms && decay(log_terms) > negligible) ++log_terms;

  const int terms = 1 << log_terms;
  psi_re.resize(terms);
  psi_im.resize(terms);
  for (int k = 0; k < terms; ++k) {
    const std::complex<double> value = psi(std::numbers::pi / width * k);
    psi_re[k] = std::real(value);
    psi_im[k] = std::imag(value);
  }
  puts.clear();
  for (int level = 0; level < levels; ++level)
    puts.push_back({x, rate, maturity, low, width, dates << level, log_terms, 0});
  if (decay(log_terms) > negligible) {
    puts.push_back(puts.back());
    --puts.back().log_terms;
  }
}

Price american_price(const Contract& c, const AmericanPut& put, const BermudanValue* values) {
  const Extrapolated value = extrapolate(values, &BermudanValue::value);
  // The boundary at maturity is no power of dt: what extrapolation gains is less than its last step. That may
  // change its sign between the levels, hence a fiftieth of what the last level has added.
  double error = 2.0 * (std::abs(value.best - value.second) + std::abs(value.second - value.third)) +
                 0.02 * std::abs(values[3].value - values[2].value);
  // Half the cosines are further off than all.
  if (put.puts.size() > AmericanPut::levels)
    error += std::abs(values[AmericanPut::levels].value - values[AmericanPut::levels - 1].value);
  error += put.folded + put.beyond + put.between;
  const double payoff = std::max(-std::expm1(put.x), 0.0);
  const bool exercised = payoff > 0.0 && payoff >= value.best;

  // The put's strike is the unit: the strike of a put, the spot of a call.
  const bool is_put = c.type == Type::put;
  const double unit = is_put ? c.strike : c.spot;
  const double slope = exercised ? -std::exp(put.x) : extrapolate(values, &BermudanValue::slope).best;
  const double curvature = exercised ? slope : extrapolate(values, &BermudanValue::curvature).best;
  Price price;
  price.price = unit * std::max(value.best, payoff);
  // Where exercise is right by more than the error, the payoff is the price.
  price.error = unit * std::max(error - std::max(payoff - value.best, 0.0), 1e-14);
  price.delta = is_put ? unit * slope / c.spot : price.price / c.spot - slope;
  price.gamma = unit * (curvature - slope) / (c.spot * c.spot);
  price.theta = exercised ? 0.0 : unit * extrapolate(values, &BermudanValue::theta).best;
  price.exercise_boundary = std::numeric_limits<double>::quiet_NaN();
  price.mesh = static_cast<int>(put.psi_re.size());
  price.steps = put.puts[AmericanPut::levels - 1].dates;
  return price;
}

}  // namespace drogue::options
