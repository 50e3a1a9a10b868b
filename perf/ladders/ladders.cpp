#include <algorithm>
#include <stdexcept>
#include <utility>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

// Each in NAME/ladder.cpp.
Ladder weno_ladder(device::Backend backend, bool small);
Ladder springs_ladder(device::Backend backend, bool small);
Ladder options_ladder(device::Backend backend, bool small);
Ladder transfers_ladder(device::Backend backend, bool small);

namespace {

constexpr std::pair<const char*, Ladder (*)(device::Backend, bool)> makers[] = {
    {"weno", weno_ladder},
    {"springs", springs_ladder},
    {"options", options_ladder},
    {"transfers", transfers_ladder}};

}  // namespace

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, make] : makers) all.emplace_back(name);
  return all;
}

Ladder create_ladder(const std::string& name, device::Backend backend, bool small) {
  for (const auto& [known, make] : makers)
    if (name == known) return make(backend, small);
  throw std::invalid_argument("there is no ladder '" + name + "'");
}

}  // namespace drogue::perf::ladder
