#pragma once

#include "perf/ladders/options/options_rung.hpp"

namespace drogue::perf::ladder {

/// All steps of option k.
template <class Arrays>
struct OptionFunctor {
  Arrays arrays;

  KOKKOS_FUNCTION void operator()(int k) const {
    const OptionStep s = arrays.step(k);
    const auto v = Kokkos::subview(arrays.v, k, Kokkos::ALL),
               right = Kokkos::subview(arrays.right, k, Kokkos::ALL),
               pivots = Kokkos::subview(arrays.pivots, k, Kokkos::ALL);
    for (int step = 1; step <= option_steps; ++step) {
      for (int i = 1; i < option_nodes - 1; ++i) {
        double jumped = 0.0;
        for (int j = 0; j < option_nodes; ++j) jumped += arrays.weights(j - i + option_nodes - 1) * v(j);
        right(i) = v(i) + s.jumps * jumped;
      }
      solve_step(s, arrays.boundary(s, step), right, pivots, v);
    }
  }
};

/// Rungs with a thread per option.
template <class ExecutionSpace, class Layout>
class OneThreadRung final : public OptionsRung<ExecutionSpace, Layout> {
  using Base = OptionsRung<ExecutionSpace, Layout>;

 public:
  using Base::Base;

 protected:
  void solve() override {
    device::launch_each(this->space(), "drogue::perf::ladder::one_thread", this->problem().options(),
                        OptionFunctor<typename Base::Arrays>{this->arrays()});
  }
};

/// Rung 1. One thread per option, the nodes of an option side by side, as a loop over options on a CPU keeps
/// them.
///
/// Prediction: arithmetic of 128 multiply-adds per node and step; the values of an option stay in caches.
template <class ExecutionSpace>
Rung one_thread_rung(const Shared<OptionsProblem>& problem) {
  return make_rung<OneThreadRung<ExecutionSpace, Kokkos::LayoutRight>>(
      RungText{"one-thread", "One thread per option, its nodes side by side.",
               "On a host 2.60 to 2.65 times the prediction: a sum of 128 products is one chain of "
               "dependent additions, so that a core waits for each, and the compiler may not reorder it. "
               "On an H100 43454 us where the model has 227 us: neighbouring threads read numbers that "
               "lie an option apart, and one thread per option is too few to hide the latency of loads "
               "(docs/lessons/tables.md)."},
      options_work(*problem, 1, 40), problem);
}

}  // namespace drogue::perf::ladder
