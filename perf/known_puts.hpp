#pragma once

#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::perf {

/// American puts of strike 1 that differ in their spot alone, and their prices.
struct KnownPuts {
  const char* name;
  options::Contract contract;
  std::vector<double> spots, prices;
};

/// The dissertation's contract. Prices are those of Bermudan options by cosine series, extrapolated, within
/// 1e-7 of independent finite differences.
const KnownPuts& thesis_puts();

/// That; the same for five years; normal inverse Gaussian jumps alone, and with diffusion for a day, as well
/// known; Merton's jumps (d'Halluin, Forsyth and Labahn 2004, more digits by this project's reference
/// computation) and none (a year, volatility 0.2, rate 0.05: QuantLib's QdFp at its highest precision).
const std::vector<KnownPuts>& known_puts();

}  // namespace drogue::perf
