#pragma once

#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/weno/fused_stages.hpp"
#include "perf/ladders/weno/fused_step.hpp"
#include "perf/ladders/weno/graph.hpp"
#include "perf/ladders/weno/on_device.hpp"
#include "perf/ladders/weno/one_division.hpp"
#include "perf/ladders/weno/persistent.hpp"
#include "perf/ladders/weno/port.hpp"
#include "perf/ladders/weno/registers.hpp"
#include "perf/ladders/weno/split_precision.hpp"

namespace drogue::perf::ladder {

/// Rungs of the WENO ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_weno(bool small) {
  const bool host = device::is_host<ExecutionSpace>;
  const std::int64_t cells = small ? 512 : host ? 4096 : 8192;
  const long steps = small ? 6 : host ? 10 : 50;
  const auto problem = std::make_shared<const WenoProblem>(make_weno_problem(cells, steps));
  // Rounding of some thousand operations per value.
  constexpr double tolerance = 1e-12;
  Ladder ladder{"weno", "step", "Sod's shock tube by WENO5-JS and SSP-RK3 with steps of one size",
                cells,  steps,  {}};
  const auto add = [&]<class Type>() { ladder.rungs.push_back(make_rung<Type>(problem, tolerance)); };
  add.template operator()<PortRung<ExecutionSpace>>();
  add.template operator()<OnDeviceRung<ExecutionSpace>>();
  add.template operator()<FusedStagesRung<ExecutionSpace>>();
  add.template operator()<DifferencesRung<ExecutionSpace>>();
  add.template operator()<OneDivisionRung<ExecutionSpace>>();
  add.template operator()<RegistersRung<ExecutionSpace>>();
  add.template operator()<FusedStepRung<ExecutionSpace>>();
  add.template operator()<GraphRung<ExecutionSpace>>();
  add.template operator()<PersistentRung<ExecutionSpace>>();
  add.template operator()<SplitPrecisionRung<ExecutionSpace>>();
  return ladder;
}

}  // namespace drogue::perf::ladder
