#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/fabric/solver.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/springs/problem.hpp"

namespace drogue::perf::ladder {

/// Base of the last rungs: the solver of `kernels/fabric/`, with one driver.
template <class ExecutionSpace>
class FabricRung final : public RungRun {
 public:
  FabricRung(const SpringProblem& problem, fabric::Driver driver) : _problem(problem) {
    fabric::Parameters p = problem.renumbered.parameters;
    p.driver = driver;
    p.dt = problem.dt;
    _solver = fabric::create_solver(device::backend_of<ExecutionSpace>, p);
  }

  void reset() override { _solver->upload(_problem.renumbered.start.x, _problem.renumbered.start.v); }

  void run() override {
    _solver->enqueue_steps(_problem.steps);
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

}  // namespace drogue::perf::ladder
