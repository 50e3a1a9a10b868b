#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/linear/poisson/problem.hpp"

namespace drogue::perf::pressure {

/// Solver of a pressure equation with two unrelated right-hand sides in turn, so that an iterative solver
/// gains nothing by starting from its last solution.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Solves `count` times; blocks.
  virtual void solve(long count) = 0;
  /// Right-hand side of the last solve, 1/m^2, and its solution.
  [[nodiscard]] virtual const std::vector<double>& right_hand_side() const = 0;
  [[nodiscard]] virtual std::vector<double> solution() const = 0;
  /// Iterations of the last solve; 0 for a direct solver.
  [[nodiscard]] virtual int iterations() const = 0;
};

/// True if this build can solve the problem by this method on this backend; `in_slabs`: as the ranks of a
/// device do. Does not throw.
[[nodiscard]] bool is_available(device::Backend backend, const linear::PoissonProblem& problem,
                                flow::PressureSolver method, bool in_slabs = false);

/// Solver by a method other than `automatic`, to a relative residual of `tolerance` if it iterates.
/// `in_slabs`: a direct one with the kernels of several ranks, but one slab. Throws std::runtime_error if
/// memory runs out.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend,
                                                    const linear::PoissonProblem& problem,
                                                    flow::PressureSolver method, double tolerance,
                                                    bool in_slabs = false);

}  // namespace drogue::perf::pressure
