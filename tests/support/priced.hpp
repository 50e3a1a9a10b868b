#pragma once

#include <vector>

#include "kernels/options/pricer.hpp"
#include "tests/support/backend.hpp"

// Prices of contracts on the backend of the test program.

namespace drogue::testing {

inline options::Settings on_mesh(int mesh, int steps) {
  options::Settings settings;
  settings.mesh = mesh;
  settings.steps = steps;
  return settings;
}

inline std::vector<options::Price> priced(const options::Settings& settings,
                                          const std::vector<options::Contract>& contracts) {
  std::vector<options::Price> prices(contracts.size());
  options::create_pricer(tested_backend, settings)->price(contracts, prices);
  return prices;
}

/// European prices by Fourier's integral, to ten digits.
inline std::vector<options::Price> priced_by_fourier(const std::vector<options::Contract>& contracts) {
  options::Settings settings;
  settings.method = options::Method::cos;
  return priced(settings, contracts);
}

}  // namespace drogue::testing
