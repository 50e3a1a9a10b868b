#pragma once

#include <memory>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Problem of a ladder, which all of its rungs and their runs share.
template <class Problem>
using Shared = std::shared_ptr<const Problem>;

/// Maker of a run, of class `Run` made from the problem and further arguments.
template <class Run, class Problem, class... More>
std::function<std::unique_ptr<RungRun>()> run_of(const Shared<Problem>& problem, const More&... more) {
  return [=] { return std::make_unique<Run>(*problem, more...); };
}

/// Rung with such runs and the tolerance of its problem.
template <class Run, class Problem, class... More>
Rung make_rung(const RungText& text, const Work& work, const Shared<Problem>& problem, const More&... more) {
  return {.text = text,
          .work = work,
          .tolerance = Problem::tolerance,
          .available = true,
          .make = run_of<Run>(problem, more...)};
}

/// The rung where its idea needs a GPU.
template <class ExecutionSpace>
Rung on_gpu(Rung rung) {
  rung.available = !device::is_host<ExecutionSpace>;
  return rung;
}

}  // namespace drogue::perf::ladder
