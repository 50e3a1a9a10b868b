#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/device/host_cores.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::flow {

/// Number of host threads for one of `ranks` ranks: a thread with fewer cells costs more than it saves. Does
/// not throw.
inline int host_threads(const Parameters& p, int ranks) {
  const std::int64_t cells = static_cast<std::int64_t>(p.cells[0]) * p.cells[1] * p.cells[2];
  return device::useful_threads(cells / ranks, 2048);
}

/// Number of host threads for a rank of `group`; the ranks share the cores of a host. Does not throw.
template <class ExecutionSpace>
int host_threads(const Parameters& p, const linear::RankGroup& group) {
  const int useful = host_threads(p, group.size());
  if (group.ranks_on_host() == 1) return useful;
  return std::clamp(ExecutionSpace().concurrency() / group.ranks_on_host(), 1, useful);
}

}  // namespace drogue::flow
