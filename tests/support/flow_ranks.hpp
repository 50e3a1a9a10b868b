#pragma once

#include "kernels/flow/solver.hpp"
#include "tests/support/ranks.hpp"

namespace drogue::testing {

/// Part of a whole array of the state of a flow.
inline std::vector<double> cut(const std::vector<double>& values, const stepping::StateArray& array) {
  return cut(values, flow::x_first(array.whole), {flow::x_first(array.begin), flow::x_first(array.extent)});
}

/// Whole array of the state of a flow, on all ranks.
inline std::vector<double> joined(const linear::RankGroup& group, flow::Solver& solver,
                                  const stepping::StateArray& array) {
  std::vector<double> own(array.size());
  solver.download(array.name, own);
  return joined(group, own, flow::x_first(array.whole),
                {flow::x_first(array.begin), flow::x_first(array.extent)});
}

}  // namespace drogue::testing
