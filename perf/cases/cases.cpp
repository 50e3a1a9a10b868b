#include "perf/cases/cases.hpp"

#include <algorithm>
#include <iterator>

#include "kernels/device/backend.hpp"

namespace drogue::perf {

std::vector<device::Backend> present_backends() {
  std::vector<device::Backend> backends = device::compiled_backends();
  std::erase_if(backends, [](device::Backend backend) { return !device::is_present(backend); });
  return backends;
}

std::vector<Case> all_cases(bool quick) {
  std::vector<Case> cases = gas_cases(quick);
  for (std::vector<Case> more :
       {fabric_cases(quick), contact_cases(quick), options_cases(quick), flow_cases(quick),
        parachute_cases(quick), tridiagonal_cases(quick), ceiling_cases()})
    std::ranges::move(more, std::back_inserter(cases));
  return cases;
}

}  // namespace drogue::perf
