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
      "On an H100 at 8192 cells a step takes 9.97 us where the model has 5.10 us, for it has "
      "launches but neither the latency of loads nor chains of operations. The graph takes 1.90 "
      "times as long as the persistent kernel, 5.25 us (docs/lessons/tables.md)."};
  static constexpr bool available = !device::is_host<ExecutionSpace>;

  static Work work(const WenoProblem& problem) { return library_work(problem, 1); }

  explicit GraphRung(const WenoProblem& problem) : LibraryRung<ExecutionSpace>(problem, gas::Driver::graph) {}
};

}  // namespace drogue::perf::ladder
