#pragma once

#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::perf {

/// American puts of strike 1 that differ only in their spot, and their prices, in units of the strike.
struct KnownPuts {
  const char* name;
  options::Contract contract;
  std::vector<double> spots, prices;
};

/// Contract of [Shi]. The prices are extrapolated COS prices of Bermudan options, within
/// 1e-7 of an independent finite-difference solution. Does not throw.
const KnownPuts& thesis_puts();

/// Six contracts: that of `thesis_puts`; the same with a maturity of five years; normal inverse Gaussian
/// jumps without diffusion, and with diffusion and a maturity of one day, both priced as `thesis_puts`;
/// Merton jumps (d'Halluin, Forsyth and Labahn 2004, with more digits from the COS reference); and no jumps
/// (one year, volatility 0.2, rate 0.05: QuantLib's QdFp engine at its highest precision). Does not throw.
const std::vector<KnownPuts>& known_puts();

}  // namespace drogue::perf
