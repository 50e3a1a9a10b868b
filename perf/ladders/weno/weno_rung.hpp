#pragma once

#include <limits>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/weno/problem.hpp"
#include "perf/ladders/weno/tile.hpp"

namespace drogue::perf::ladder {

/// Base of the rungs with kernels of their own: the problem, and the state in three buffers. A rung
/// defines `step`.
template <class ExecutionSpace>
class WenoRung : public RungRun {
 public:
  using State = Fields<ExecutionSpace>;

  explicit WenoRung(const WenoProblem& problem)
      : _problem(problem), _instance(std::numeric_limits<int>::max()) {
    for (State& buffer : _buffers) buffer = State("drogue::perf::ladder::state", size());
  }

  void reset() override {
    for (std::size_t k = 0; k < 3; ++k) device::copy_in(space(), row(k), _problem.start[k].data(), size());
    space().fence("drogue::perf::ladder: state is set");
  }

  void run() override {
    for (long step = 0; step < _problem.steps; ++step) this->step();
    space().fence("drogue::perf::ladder: steps are done");
  }

  [[nodiscard]] double error() override {
    sod::Fields got;
    for (std::size_t k = 0; k < 3; ++k) {
      got[k].resize(size());
      device::copy_out(space(), got[k].data(), row(k), size());
    }
    space().fence("drogue::perf::ladder: state is read");
    return difference(_problem, got);
  }

 protected:
  /// Enqueues or does one step.
  virtual void step() = 0;

  [[nodiscard]] const ExecutionSpace& space() const { return _instance.space(); }
  [[nodiscard]] const WenoProblem& problem() const { return _problem; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_problem.cells()); }

  /// Buffer of U^n for role 0, then two others.
  [[nodiscard]] const State& buffer(int role) const { return _buffers[(_current + role) % 3]; }

  /// Makes the buffer of a role that of U^n.
  void advance_buffers(int role) { _current = (_current + role) % 3; }

 private:
  [[nodiscard]] auto row(std::size_t k) const { return Kokkos::subview(buffer(0), Kokkos::ALL, k); }

  const WenoProblem& _problem;
  device::Instance<ExecutionSpace> _instance;
  State _buffers[3];
  int _current = 0;
};

}  // namespace drogue::perf::ladder
