#include <cstdio>
#include <exception>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "kernels/options/contract_check.hpp"
#include "kernels/options/pricer.hpp"

// option_prices [BACKEND]: prices puts of strike 40 by the library of drogue-options, with the error that it
// estimates: two American ones, without and with the jumps of Merton (1976), and the European one with jumps.
using namespace drogue;

std::vector<options::Contract> contracts() {
  options::Contract diffusion{
      .model = options::JumpModel::black_scholes,
      .spot = 40.0,
      .strike = 40.0,
      .rate = 0.05,  // per year
      .maturity = 0.5,
      .variance = 0.3 * 0.3,  // per year
  };
  options::Contract with_jumps = diffusion;
  with_jumps.model = options::JumpModel::merton;
  with_jumps.jump[0] = 0.5;   // jumps per year
  with_jumps.jump[1] = -0.1;  // mean of the logarithm of a jump
  with_jumps.jump[2] = 0.2;   // its standard deviation
  options::Contract european = with_jumps;
  european.style = options::Style::european;
  return {diffusion, with_jumps, european};
}

int main(int argc, char** argv) try {
  const device::Backend backend = device::wanted_backend(argc > 1 ? argv[1] : "auto");
  if (const auto why = device::why_unavailable(backend)) {
    std::fprintf(stderr, "%s\n", why->c_str());
    return 77;
  }
  const device::Runtime runtime({});
  const auto pricer = options::create_pricer(backend, {.tolerance = 1e-5});

  const std::vector<options::Contract> puts = contracts();
  for (const options::Contract& put : puts)
    if (const auto violated = options::violated_condition(put); !violated.empty()) {
      std::fprintf(stderr, "invalid contract: %s\n", violated.data());
      return 3;
    }
  std::vector<options::Price> prices(puts.size());
  pricer->price(puts, prices);
  std::printf("price error delta\n");
  for (const options::Price& put : prices) {
    if (put.status == options::PriceStatus::failed) return 4;
    std::printf("%.5f %.5f %.4f\n", put.price, put.error, put.delta);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\nusage: option_prices [BACKEND]\n", error.what());
  return 2;
}
