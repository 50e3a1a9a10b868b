#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/fabric/solver.hpp"
#include "perf/ladders/springs/problem.hpp"

namespace drogue::perf::ladder {

/// Base of the last rungs: the solver of `kernels/fabric/`, with one driver.
template <class ExecutionSpace>
class FabricRung : public RungRun {
 public:
  FabricRung(const SpringProblem& problem, fabric::Driver driver) : _problem(problem) {
    fabric::Parameters p = problem.renumbered.parameters;
    p.driver = driver;
    p.dt = problem.dt;
    _solver = fabric::create_solver(device::backend_of<ExecutionSpace>, p);
  }

  void reset() override { _solver->upload(_problem.renumbered.start.x, _problem.renumbered.start.v); }

  void run() override {
    _solver->advance(_problem.steps);
    static_cast<void>(_solver->failure());  // blocks until the steps are done
  }

  [[nodiscard]] double error() override {
    sheet::State now = _problem.renumbered.start;
    _solver->download(now.x, now.v);
    return difference(_problem.renumbered, now.x);
  }

 private:
  const SpringProblem& _problem;
  std::unique_ptr<fabric::Solver> _solver;
};

/// Work per step of four stages with `launches` kernels each, three stored numbers per triangle and edges
/// that two triangles share. Does not throw.
inline Work ring_work(const SpringProblem& problem, double launches) {
  Work work = spring_work(problem, launches, 3, 48);
  work.packed = true;
  return work;
}

/// Rung 5. The solver of the library (kernels/fabric/stepping/step.hpp): rings of neighbours share the edges
/// of their triangles, in sliced ELLPACK rows. It also tests the state for divergence.
///
/// Prediction: one number less per triangle, a third of the edges less to compute, and packs on a host.
template <class ExecutionSpace>
class RingsRung final : public FabricRung<ExecutionSpace> {
 public:
  static constexpr RungText text{
      "rings", "Triangles around a vertex share their edges: the library's kernel.",
      "By far the largest gain, to near the bound of memory: the library computes packs of "
      "vertices from sliced rows, so that a host reads neighbouring numbers at once, as the "
      "arrays of rung 2 were meant to be read."};

  static Work work(const SpringProblem& problem) { return ring_work(problem, 1); }

  explicit RingsRung(const SpringProblem& problem)
      : FabricRung<ExecutionSpace>(problem, fabric::Driver::plain) {}
};

/// Rung 6, GPU only: the kernels of a step are captured once into a CUDA graph.
///
/// Prediction: one launch per step instead of four.
template <class ExecutionSpace>
class SpringGraphRung final : public FabricRung<ExecutionSpace> {
 public:
  static constexpr RungText text{
      "graph", "The kernels of a step as one CUDA graph.",
      "On an H100 the graph gains little: 14.0 us, after 15.4 us without it, where the model "
      "has 24.1 us, after 43.5 us. The model counts a launch at the time of an empty one alone, "
      "and has no caches, which hold this mesh (docs/lessons/tables.md)."};
  static constexpr bool available = !device::is_host<ExecutionSpace>;

  static Work work(const SpringProblem& problem) { return ring_work(problem, 0.25); }

  explicit SpringGraphRung(const SpringProblem& problem)
      : FabricRung<ExecutionSpace>(problem, fabric::Driver::graph) {}
};

/// Rung 7, GPU only: one launch takes all steps. Patches of vertices stay in shared memory and exchange their
/// halos by messages of value and tag, without a barrier (kernels/fabric/stepping/persistent_steps.hpp).
///
/// Prediction: one launch for all steps, no memory traffic to speak of; arithmetic remains.
template <class ExecutionSpace>
class PacketsRung final : public FabricRung<ExecutionSpace> {
 public:
  static constexpr RungText text{
      "packets", "One launch for all steps; patches exchange tagged messages.",
      "Left over is the latency of messages between patches, which the model omits "
      "(docs/springs-notebook.md). On an H100 8.41 us where the model has 1.54 us "
      "(docs/lessons/tables.md)."};
  static constexpr bool available = !device::is_host<ExecutionSpace>;

  static Work work(const SpringProblem& problem) {
    Work work = ring_work(problem, 0.25 / static_cast<double>(problem.steps));
    work.bytes = 0.0;
    return work;
  }

  explicit PacketsRung(const SpringProblem& problem)
      : FabricRung<ExecutionSpace>(problem, fabric::Driver::persistent) {}
};

}  // namespace drogue::perf::ladder
