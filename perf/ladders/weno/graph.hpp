#pragma once

#include "perf/ladders/weno/library_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 8, GPU only: the kernels of a step are captured once into a CUDA graph, which is launched per step.
///
/// Prediction: one launch per step instead of two.
template <class ExecutionSpace>
class GraphRung final : public LibraryRung<ExecutionSpace> {
 public:
  static constexpr RungText text{
      "graph", "The kernels of a step as one CUDA graph.",
      "On an H200 at 8192 cells the step in a graph takes twice the time of the persistent "
      "kernel (docs/gas-notebook.md, steps on a GPU); the record of this ladder on a GPU is "
      "still to be made."};
  static constexpr bool available = !device::is_host<ExecutionSpace>;

  static Work work(const WenoProblem& problem) { return library_work(problem, 1); }

  explicit GraphRung(const WenoProblem& problem) : LibraryRung<ExecutionSpace>(problem, gas::Driver::graph) {}
};

}  // namespace drogue::perf::ladder
