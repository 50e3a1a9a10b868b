#pragma once

#include <limits>
#include <string>
#include <type_traits>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/options/problem.hpp"

namespace drogue::perf::ladder {

/// Arrays of a batch on a backend. `Layout`: right, the nodes of an option lie together; left, the options of
/// a node.
template <class ExecutionSpace, class Layout>
struct OptionArrays {
  using Memory = typename ExecutionSpace::memory_space;
  using Values = Kokkos::View<double**, Layout, Memory>;

  Values v, right, pivots;  ///< (options, nodes)
  Kokkos::View<OptionStep*, Memory> step;
  Kokkos::View<double*, Memory> weights;  ///< as in the problem
  double low;

  /// Value at the first node after step `k`, in strikes.
  KOKKOS_FUNCTION double boundary(const OptionStep& s, int k) const {
    return Kokkos::exp(-k * s.rate_dt) - Kokkos::exp(low);
  }
};

/// Elimination and substitution (Thomas algorithm) of one option: `right(i)` in, `v(i)` out, `pivots(i)` work
/// space. `Step`: an OptionStep, or one of the real type `R`, of which tests count the operations.
template <class Step, class R, class Right, class Pivots, class V>
KOKKOS_INLINE_FUNCTION void solve_step(const Step& s, R boundary, const Right& right, const Pivots& pivots,
                                       const V& v) {
  R value = boundary, ratio = 0.0;
  v(0) = boundary;
  for (int i = 1; i < option_nodes - 1; ++i) {
    const R inverse = 1.0 / (s.diagonal - s.lower * ratio);
    value = (right(i) + s.lower * value) * inverse;
    ratio = s.upper * inverse;
    v(i) = value, pivots(i) = ratio;
  }
  value = v(option_nodes - 1) = 0.0;
  for (int i = option_nodes - 2; i > 0; --i) v(i) = value = v(i) + pivots(i) * value;
}

/// Base of the rungs. A rung defines `solve`, from the payoff in `arrays().v` to the values there.
template <class ExecutionSpace, class Layout>
class OptionsRung : public RungRun {
 public:
  using Arrays = OptionArrays<ExecutionSpace, Layout>;

  explicit OptionsRung(const OptionsProblem& problem)
      : _problem(problem), _instance(std::numeric_limits<int>::max()) {
    const auto values = [&](const std::string& label) {
      return typename Arrays::Values(label, problem.steps.size(), option_nodes);
    };
    _arrays = {.v = values("drogue::perf::ladder::values"),
               .right = values("drogue::perf::ladder::right"),
               .pivots = values("drogue::perf::ladder::pivots"),
               .step = decltype(_arrays.step)("drogue::perf::ladder::steps", problem.steps.size()),
               .weights = decltype(_arrays.weights)("drogue::perf::ladder::weights", problem.weights.size()),
               .low = problem.low};
    device::copy_in(space(), _arrays.step, problem.steps.data(), problem.steps.size());
    device::copy_in(space(), _arrays.weights, problem.weights.data(), problem.weights.size());
    space().fence("drogue::perf::ladder: options are copied");
  }

  void reset() override {
    std::vector<double> payoffs(_arrays.v.size());
    for (int k = 0; k < _problem.options(); ++k)
      for (int i = 0; i < option_nodes; ++i)
        payoffs[offset(k, i)] = _problem.payoff[static_cast<std::size_t>(i)];
    device::copy_in(space(), _arrays.v, payoffs.data(), payoffs.size());
    space().fence("drogue::perf::ladder: payoffs are copied");
  }

  void run() override {
    solve();
    space().fence("drogue::perf::ladder: options are solved");
  }

  [[nodiscard]] double error() override {
    std::vector<double> got(_arrays.v.size()), rows;
    device::copy_out(space(), got.data(), _arrays.v, got.size());
    space().fence("drogue::perf::ladder: values are on the host");
    for (int k = 0; k < _problem.options(); ++k)
      for (int i = 0; i < option_nodes; ++i) rows.push_back(got[offset(k, i)]);
    return difference(_problem, rows);
  }

 protected:
  /// Enqueues all steps of the batch.
  virtual void solve() = 0;

  [[nodiscard]] const ExecutionSpace& space() const { return _instance.space(); }
  [[nodiscard]] const Arrays& arrays() const { return _arrays; }
  [[nodiscard]] const OptionsProblem& problem() const { return _problem; }

 private:
  [[nodiscard]] std::size_t offset(int k, int i) const {
    const auto row = static_cast<std::size_t>(k), column = static_cast<std::size_t>(i);
    return std::is_same_v<Layout, Kokkos::LayoutRight> ? row * option_nodes + column
                                                       : column * _problem.steps.size() + row;
  }

  const OptionsProblem& _problem;
  device::Instance<ExecutionSpace> _instance;
  Arrays _arrays;
};

}  // namespace drogue::perf::ladder
