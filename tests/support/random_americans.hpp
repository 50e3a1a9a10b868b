#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/support/priced.hpp"

namespace drogue::testing {

/// Random American contracts, three puts for a call, of strike 100, and as many again within 10 % of the
/// exercise boundaries of the former, most of them within 1 %.
inline std::vector<options::Contract> random_americans(std::size_t count, std::uint64_t seed) {
  using options::Contract, options::JumpModel, options::Type;
  std::mt19937_64 bits(seed);
  const auto in = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  };
  std::vector<Contract> contracts(count);
  for (std::size_t k = 0; k < count; ++k) {
    Contract& c = contracts[k];
    c.model = static_cast<JumpModel>(k % 4);
    c.type = in(0.0, 1.0) < 0.75 ? Type::put : Type::call;
    c.strike = 100.0;
    c.spot = 100.0 * std::exp(in(-0.4, 0.4));
    c.maturity = std::exp(in(std::log(0.02), std::log(5.0)));
    c.rate = in(0.005, 0.12);
    c.dividend = in(0.0, 1.0) < 0.5 ? 0.0 : in(0.0, 0.08);
    if (c.type == Type::call) std::swap(c.rate, c.dividend);
    c.variance = in(0.005, 0.16);
    const double alpha = in(5.0, 30.0);
    const double jumps[4][4] = {{in(-2.0, 2.0), alpha, in(-0.6, 0.3) * alpha - 0.5, in(0.05, 1.0)},
                                {},
                                {in(0.1, 3.0), in(-0.3, 0.1), in(0.05, 0.4)},
                                {in(0.1, 5.0), in(0.0, 1.0), in(3.0, 20.0), in(2.0, 20.0)}};
    std::copy_n(jumps[k % 4], 4, c.jump);
  }
  const std::vector<options::Price> prices = priced(on_mesh(512, 128), contracts);
  for (std::size_t k = 0; k < count; ++k) {
    Contract beside = contracts[k];
    const double distances[] = {0.1, 0.01, 0.01, 0.003};
    beside.spot = prices[k].exercise_boundary * (1.0 + in(-1.0, 1.0) * distances[k / 4 % 4]);
    if (beside.spot > 1.0 && beside.spot < 1e4) contracts.push_back(beside);
  }
  return contracts;
}

}  // namespace drogue::testing
