#include <algorithm>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

Prediction predict(const Work& work, const Ceilings& ceilings) {
  const double lanes = work.packed ? 1.0 : ceilings.lanes;
  const double divisions = work.packed ? ceilings.divisions : ceilings.scalar_divisions;
  const double copies =
      work.copies * ceilings.copy + work.copied_bytes / (work.pinned ? ceilings.pinned : ceilings.pageable);
  const Prediction parts[] = {
      {work.launches * ceilings.launch, "launches"},
      {copies, "copies"},
      {work.bytes / ceilings.bandwidth, "memory"},
      {lanes * work.flops / ceilings.flops + work.divisions / divisions, "arithmetic"}};
  const double kernels = parts[0].seconds + std::max(parts[2].seconds, parts[3].seconds);
  const Prediction& longest = *std::ranges::max_element(parts, {}, &Prediction::seconds);
  return {work.overlapped ? std::max(copies, kernels) : copies + kernels, longest.bound};
}

}  // namespace drogue::perf::ladder
