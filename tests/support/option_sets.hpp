#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::testing {

/// Puts of strike 1 without dividends with known prices. European prices: two Fourier methods that agree to
/// 1e-12. American prices: Bermudan cosine series with Romberg extrapolation, which agree with independent
/// finite differences to 1e-7.
struct OptionSet {
  std::string name;
  double lambda, alpha, beta, delta, variance, rate, maturity;
  std::array<double, 7> spot, american, european;
};

inline const std::vector<OptionSet>& option_sets() {
  static const std::vector<OptionSet> sets = {
      {"TH",
       1,
       8.15,
       -2.5,
       0.767,
       0.4,
       0.1,
       1.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.507616711, 0.318658312, 0.275403193, 0.239004005, 0.208230166, 0.182096749, 0.069850678},
       {0.4594475244276, 0.297737956916, 0.258871830329, 0.2257447264999, 0.1974598461874, 0.1732519407341,
        0.06744624042995}},
      {"THv",
       1,
       8.15,
       -2.5,
       0.767,
       0.16,
       0.1,
       1.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.5, 0.261046214, 0.210954563, 0.170964926, 0.139020315, 0.113466691, 0.025978},
       {0.428024972048, 0.2371368232881, 0.1936689111774, 0.1582411308481, 0.1295078269413, 0.1062566423408,
        0.02484477141657}},
      {"NIG0",
       -0.5,
       15,
       -5,
       0.5,
       0,
       0.05,
       1.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.5, 0.2, 0.11228793, 0.05995326, 0.031011482, 0.015910025, 0.000152331},
       {0.4512425639193, 0.1665125778125, 0.09854606925468, 0.05400856796091, 0.02837129962803,
        0.01470061119654, 0.0001442572684529}},
      {"VGB",
       2.0,
       11,
       -5,
       0.0,
       0.0225,
       0.05,
       1.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.5, 0.204614812, 0.136958436, 0.09124399, 0.061155913, 0.041541847, 0.003378044},
       {0.4514556819318, 0.1846686804849, 0.1258938024336, 0.08470797258619, 0.05713610029444,
        0.03898241804255, 0.003214135143668}},
      {"HT",
       -1.2,
       3,
       -1.5,
       0.4,
       0.01,
       0.05,
       1.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.5, 0.211027882, 0.147163522, 0.102753231, 0.072885936, 0.05299171, 0.009374641},
       {0.4532358363408, 0.1963571728533, 0.1388032570389, 0.09760667865955, 0.06950465675661,
        0.05064444782692, 0.008993490036306}},
      {"THl",
       1,
       8.15,
       -2.5,
       0.767,
       0.4,
       0.1,
       5.0,
       {0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 2.0},
       {0.556047009, 0.439214241, 0.412142144, 0.388679947, 0.368075278, 0.349783538, 0.252648547},
       {0.3785906147667, 0.3194545387771, 0.3041822913619, 0.2904687280878, 0.278060840568, 0.266761432023,
        0.2023382613845}},
      {"THs",
       1,
       8.15,
       -2.5,
       0.767,
       0.4,
       0.1,
       1.0 / 365,
       {0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1},
       {0.1, 0.051096542, 0.026146075, 0.014164183, 0.00667399, 0.001869918, 0.000444583},
       {0.09986790621794, 0.05108010179857, 0.02614283855364, 0.01416298113534, 0.006673382681215,
        0.001869573417341, 0.0004443936211606}},
      {"NIGBs",
       -0.5,
       15,
       -5,
       0.5,
       0.04,
       0.05,
       1.0 / 365,
       {0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1},
       {0.1, 0.05, 0.020285823, 0.004904692, 0.000657209, 0.000216626, 7.994e-05},
       {0.0998736666582, 0.04992816737505, 0.02028364854811, 0.004904300296082, 0.0006570071289643,
        0.0002165285593299, 7.99021583896e-05}},
  };
  return sets;
}

/// Contract with spot k of a set.
inline options::Contract contract_of(const OptionSet& set, std::size_t k, options::Style style) {
  options::Contract c;
  c.style = style;
  c.spot = set.spot[k];
  c.rate = set.rate;
  c.maturity = set.maturity;
  c.variance = set.variance;
  c.jump[0] = set.lambda;
  c.jump[1] = set.alpha;
  c.jump[2] = set.beta;
  c.jump[3] = set.delta;
  return c;
}

/// Random contracts with generalized hyperbolic jumps: both styles and types, maturities of 0.1 to 3 years,
/// about one in seven with variance gamma jumps.
inline std::vector<options::Contract> random_contracts(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto in = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  };
  std::vector<options::Contract> contracts(count);
  for (options::Contract& c : contracts) {
    c.style = in(0, 1) < 0.8 ? options::Style::american : options::Style::european;
    c.type = in(0, 1) < 0.5 ? options::Type::put : options::Type::call;
    c.maturity = std::exp(in(std::log(0.1), std::log(3.0)));
    c.rate = in(0.0, 0.1);
    c.dividend = in(0, 1) < 0.3 ? 0.0 : in(0.0, 0.08);
    c.variance = in(0.005, 0.3);
    const double alpha = in(4.0, 15.0);
    c.jump[0] = in(-2.0, 2.0);
    c.jump[1] = alpha;
    c.jump[2] = -0.5 + in(-0.7, 0.7) * (alpha - 0.5);
    c.jump[3] = std::exp(in(std::log(0.1), std::log(1.5)));
    if (in(0, 1) < 0.15) {
      c.jump[3] = 0.0;
      c.jump[0] = 0.5 + std::abs(c.jump[0]);
    }
    c.strike = in(0.5, 200.0);
    c.spot = c.strike * std::exp(in(-1.0, 1.0) * std::min(0.4, 0.6 * std::sqrt(c.maturity)));
  }
  return contracts;
}

}  // namespace drogue::testing
