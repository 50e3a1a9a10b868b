#include "kernels/options/cos/american.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/options/greek_bounds.hpp"

namespace drogue::options {
namespace {

/// Richardson extrapolations of a quantity over all four levels, the three finest, and the two finest.
struct Extrapolated {
  double four_levels, three_levels, two_levels;
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
      psi(c.type == Type::put ? CharacteristicExponent(c) : CharacteristicExponent(c).dual()) {}

void AmericanPut::prepare(double expiry, int dates, double tolerance) {
  const double max_discount = std::log(10.0 + 10.0 / tolerance);
  const double maturity = rate * expiry > max_discount ? max_discount / rate : expiry;
  truncation_error = maturity < expiry ? std::exp(-max_discount) : 0.0;
  const CharacteristicExponent::Cumulants c = psi.cumulants();
  // The loss from a delayed exercise is at most the carry that exercise earns in the meantime. If that
  // exceeds the strike between two dates of the coarsest level, or the drift moves the spot by more than a
  // standard deviation, all levels may miss the exercise region and agree with each other.
  // The last interval is the longest.
  const auto longest_interval = [=](int n) { return maturity - exercise_date(maturity, n - 1, n); };
  const double interval = longest_interval(dates), carry = std::max(rate, rate - dividend);
  const int finest = dates << (levels - 1);
  const bool too_few = carry * interval > 1.0 || c.mean * c.mean * interval > c.second;
  date_error =
      too_few ? -std::expm1(-carry * longest_interval(finest)) * std::exp(std::max(-rate * maturity, 0.0))
              : 0.0;
  const CharacteristicExponent::JumpRange range = psi.jump_range();
  constexpr double deviations = 12.0;
  // The cosine series folds back (aliases) the probability beyond this distance.
  constexpr double max_distance = 100.0;
  const double spread =
      deviations * std::sqrt(c.second * maturity + std::sqrt(std::abs(c.fourth) * maturity));
  const double shift = c.mean * maturity;
  const double low =
      std::min(x, 0.0) - std::min(std::max(spread, range.down) + std::max(-shift, 0.0), max_distance);
  const double high =
      std::max(x, 0.0) + std::min(std::max(spread, range.up) + std::max(shift, 0.0), max_distance);
  const double width = high - low;
  aliasing_error =
      std::exp(-CharacteristicExponent::jump_range_digits * max_distance / std::max(range.down, 1.0));

  // Within the shortest interval, the first one. A coarser level needs fewer cosines.
  const auto decay = [&](int level_dates, int log_terms) {
    const double dt = exercise_date(maturity, 1, level_dates);
    return std::exp(dt * std::real(psi(std::numbers::pi / width * (1 << log_terms))));
  };
  constexpr double negligible = 1e-10;
  puts.clear();
  int log_terms = 6;
  for (int level = 0; level < levels; ++level) {
    const int level_dates = dates << level;
    while (log_terms < max_log_terms && decay(level_dates, log_terms) > negligible) ++log_terms;
    puts.push_back({.x = x,
                    .rate = rate,
                    .maturity = maturity,
                    .low = low,
                    .width = width,
                    .dates = level_dates,
                    .log_terms = log_terms,
                    .table = 0});
  }
  const int terms = 1 << log_terms;
  psi_re.resize(terms);
  psi_im.resize(terms);
  for (int k = 0; k < terms; ++k) {
    const std::complex<double> value = psi(std::numbers::pi / width * k);
    psi_re[k] = std::real(value);
    psi_im[k] = std::imag(value);
  }
  if (decay(finest, log_terms) > negligible) {
    puts.push_back(puts.back());
    --puts.back().log_terms;
  }
}

Price american_price(const Contract& c, const AmericanPut& put, const BermudanValue* values,
                     double tolerance) {
  const Extrapolated value = extrapolate(values, &BermudanValue::value);
  // Near maturity the exercise boundary is not smooth in dt, so the last extrapolation gains less than the
  // one before. Their differences may change sign between levels: with 32 dates up to 8 % of the last
  // difference of levels remained of 468 random contracts, hence an eighth, and less with more dates.
  const double remaining = std::max(0.02, 4.0 / put.puts[AmericanPut::levels - 1].dates);
  double error = std::max(2.0 * (std::abs(value.four_levels - value.three_levels) +
                                 std::abs(value.three_levels - value.two_levels)),
                          remaining * std::abs(values[3].value - values[2].value));
  // Halving the number of cosines bounds the truncation error of the full series.
  if (put.puts.size() > AmericanPut::levels)
    error += std::abs(values[AmericanPut::levels].value - values[AmericanPut::levels - 1].value);
  const double payoff = std::max(-std::expm1(put.x), 0.0), premium = value.four_levels - payoff;
  const bool exercised = payoff > 0.0 && premium <= std::min(error, tolerance);
  // Beside the boundary, where the value has no third derivative, extrapolation is least regular.
  if (payoff > 0.0 && std::abs(premium) <= error) error *= 1.5;
  error += put.aliasing_error + put.truncation_error + put.date_error;

  // The unit of money is the strike of the put, which is the spot of a call.
  const bool is_put = c.type == Type::put;
  const double unit = is_put ? c.strike : c.spot;
  const double slope = extrapolate(values, &BermudanValue::first_derivative).four_levels;
  const double curvature = extrapolate(values, &BermudanValue::second_derivative).four_levels;
  Price price;
  price.price = unit * (exercised ? payoff : std::max(value.four_levels, payoff));
  // If exercise is optimal by more than the error, the payoff is the exact price.
  price.error = unit * std::max(exercised || premium < 0.0 ? error + premium : error, 1e-14);
  price.delta = is_put ? unit * slope / c.spot : price.price / c.spot - slope;
  price.gamma = unit * (curvature - slope) / (c.spot * c.spot);
  price.theta = unit * extrapolate(values, &BermudanValue::theta).four_levels;
  // Over the first, short interval the density of variance gamma has a pole, and the series of the second
  // derivative does not converge: it is off by up to its own size.
  if (c.model == JumpModel::generalized_hyperbolic && c.variance == 0.0 && c.jump[3] == 0.0)
    price.gamma = std::numeric_limits<double>::quiet_NaN();
  if (exercised) set_exercised_greeks(c, price);
  price.exercise_boundary = std::numeric_limits<double>::quiet_NaN();
  price.mesh = static_cast<int>(put.psi_re.size());
  price.steps = put.puts[AmericanPut::levels - 1].dates;
  return price;
}

}  // namespace drogue::options
