#include "perf/cases/cases.hpp"

#include <algorithm>
#include <iterator>

namespace drogue::perf {

std::vector<Case> all_cases(bool quick) {
  std::vector<Case> cases = gas_cases(quick);
  for (std::vector<Case> more :
       {fabric_cases(quick), contact_cases(quick), options_cases(quick), flow_cases(quick),
        parachute_cases(quick), tridiagonal_cases(quick), ceiling_cases()})
    std::ranges::move(more, std::back_inserter(cases));
  return cases;
}

}  // namespace drogue::perf
