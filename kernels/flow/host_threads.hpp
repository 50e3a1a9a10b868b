#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/flow/parameters.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::flow {

/// Number of host threads for a rank: a thread with fewer cells costs more than it saves, and ranks share the
/// cores of a host. Does not throw.
template <class ExecutionSpace>
int host_threads(const Parameters& p, const linear::RankGroup& group) {
  const std::int64_t cells = static_cast<std::int64_t>(p.cells[0]) * p.cells[1] * p.cells[2] / group.size();
  const int useful = static_cast<int>(1 + std::min<std::int64_t>(cells / 2048, 4096));
  if (group.ranks_on_host() == 1) return useful;
  return std::clamp(ExecutionSpace().concurrency() / group.ranks_on_host(), 1, useful);
}

}  // namespace drogue::flow
