#pragma once

#include "kernels/device/memory.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/weno/problem.hpp"

namespace drogue::perf::ladder {

/// Base of the last rungs: the solver of `kernels/gas/`, with one driver and precision.
template <class ExecutionSpace>
class LibraryRung final : public RungRun {
 public:
  LibraryRung(const WenoProblem& problem, gas::Driver driver, gas::Precision precision = gas::Precision::full)
      : _problem(problem) {
    gas::Parameters p = problem.parameters;
    p.driver = driver;
    p.precision = precision;
    _solver = gas::create_solver(device::backend_of<ExecutionSpace>, p);
  }

  void reset() override {
    _solver->upload(0, {_problem.start[0], _problem.start[1], _problem.start[2]});
    _solver->start();
  }

  void run() override { _solver->advance(1.0, _problem.steps, 0, {}, {}); }

  [[nodiscard]] double error() override {
    sod::Fields got;
    for (auto& values : got) values.resize(static_cast<std::size_t>(_problem.cells()));
    _solver->download(0, {got[0], got[1], got[2]});
    return difference(_problem, got);
  }

 private:
  const WenoProblem& _problem;
  std::unique_ptr<gas::Solver> _solver;
};

}  // namespace drogue::perf::ladder
