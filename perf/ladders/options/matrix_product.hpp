#pragma once

#include "kernels/linear/dense_product.hpp"
#include "perf/ladders/options/options_rung.hpp"

namespace drogue::perf::ladder {

/// A step of option k after its sums of jumps, which `arrays.right` holds.
template <class Arrays>
struct AfterProductFunctor {
  Arrays arrays;
  int step;

  KOKKOS_FUNCTION void operator()(int k) const {
    const OptionStep s = arrays.step(k);
    const auto v = Kokkos::subview(arrays.v, k, Kokkos::ALL),
               right = Kokkos::subview(arrays.right, k, Kokkos::ALL);
    for (int i = 1; i < option_nodes - 1; ++i) right(i) = v(i) + s.jumps * right(i);
    solve_step(s, arrays.boundary(s, step), right, Kokkos::subview(arrays.pivots, k, Kokkos::ALL), v);
  }
};

/// Runs with two launches per step: the product, and what follows.
template <class ExecutionSpace>
class MatrixProductRung final : public OptionsRung<ExecutionSpace, Kokkos::LayoutLeft> {
  using Base = OptionsRung<ExecutionSpace, Kokkos::LayoutLeft>;
  using List = typename linear::DenseProduct<ExecutionSpace>::List;

 public:
  explicit MatrixProductRung(const OptionsProblem& problem)
      : Base(problem),
        _product(this->space()),
        _matrix("drogue::perf::ladder::jumps", option_nodes * option_nodes) {
    std::vector<double> columns;
    for (int j = 0; j < option_nodes; ++j)
      for (int i = 0; i < option_nodes; ++i)
        columns.push_back(problem.weights[static_cast<std::size_t>(j - i + option_nodes - 1)]);
    device::copy_in(this->space(), _matrix, columns.data(), columns.size());
    this->space().fence("drogue::perf::ladder: jumps are copied");
  }

 protected:
  void solve() override {
    const auto& arrays = this->arrays();
    const List v(arrays.v.data(), arrays.v.size()), right(arrays.right.data(), arrays.right.size());
    for (int step = 1; step <= option_steps; ++step) {
      _product.along_axis({this->problem().options(), option_nodes, 1}, 1, _matrix, false, v, right);
      device::launch_each(this->space(), "drogue::perf::ladder::matrix_product", this->problem().options(),
                          AfterProductFunctor<typename Base::Arrays>{arrays, step});
    }
  }

 private:
  linear::DenseProduct<ExecutionSpace> _product;
  List _matrix;  ///< column after column
};

/// Rung 6. All options share the weights, so that the jumps of a step are one product of a matrix with the
/// values of all options: by cuBLAS, which uses the FP64 tensor cores, by the library's loop on a host.
///
/// Prediction: two launches per step, packed arithmetic, and the values of all options between memory and
/// four passes per step.
template <class ExecutionSpace>
Rung matrix_product_rung(const Shared<OptionsProblem>& problem) {
  Work work = options_work(*problem, 2 * option_steps, 72);
  work.packed = true;
  return make_rung<MatrixProductRung<ExecutionSpace>>(
      RungText{"matrix-product", "The jumps of all options as one product of matrices.",
               "On a host this rung loses to registers: the plain product of the library streams all "
               "values through the caches for each node. The tiles of a real matrix product are the "
               "blocks of rung 5. On an H100 it loses too: 2859 us, after 1133 us "
               "(docs/lessons/tables.md). There columns must share a distribution of jumps, which a "
               "batch of different options does not (docs/options-notebook.md)."},
      work, problem);
}

}  // namespace drogue::perf::ladder
