#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/hypre_struct.hpp"

namespace drogue::linear {

/// Iterative solver by hypre on the host: `HypreStructSolver` for the arrays of an execution space. On a
/// device each solve copies both arrays. Only in builds with DROGUE_HAVE_HYPRE.
template <class ExecutionSpace>
class HyprePfmgSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Sets up the multigrid levels on this rank alone. `tolerance`: ratio of the norms of residual and
  /// right-hand side as of `HypreStructSolver`, which lists the errors.
  HyprePfmgSolver(const ExecutionSpace& space, const PoissonProblem& problem, double tolerance,
                  int max_iterations = 200)
      : HyprePfmgSolver(space, problem, {}, {}, tolerance, max_iterations) {}

  /// Sets up the levels on the ranks of a group, of which each holds the cells of `box_of`; `tolerance`:
  /// ratio as above. The constructor and the solves are collective. Throws as above.
  HyprePfmgSolver(const ExecutionSpace& space, const PoissonProblem& problem, const RankGroup& group,
                  const PencilRanks& ranks, double tolerance, int max_iterations = 200)
      : _space(space),
        _cells(box_of(ranks, problem.cells).size()),
        _solver(std::make_unique<HypreStructSolver>(problem, group, box_of(ranks, problem.cells), tolerance,
                                                    max_iterations)) {
    if constexpr (!device::is_host<ExecutionSpace>) {
      _right_hand_side.resize(_cells);
      _solution.resize(_cells);
    }
  }

  /// Solves wait for the host. Does not throw.
  [[nodiscard]] static constexpr bool is_asynchronous() { return false; }

  /// Solves for `solution`, in its unit, with the right-hand side in that unit per m^2, which it keeps.
  /// Begins with the last guess or solution. Blocks until the work enqueued before and the solve are
  /// complete. Throws std::invalid_argument for an array of the wrong size and std::runtime_error if hypre
  /// fails.
  void enqueue_solve(const List& right_hand_side, const List& solution) {
    if (right_hand_side.extent(0) != _cells || solution.extent(0) != _cells)
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    if constexpr (device::is_host<ExecutionSpace>) {
      _space.fence("drogue::linear::hypre: right-hand side");
      _solver->solve(right_hand_side.data(), solution.data());
    } else {
      device::copy_out(_space, _right_hand_side.data(), right_hand_side, _cells);
      _space.fence("drogue::linear::hypre: right-hand side");
      _solver->solve(_right_hand_side.data(), _solution.data());
      device::copy_in(_space, solution, _solution.data(), _cells);
      _space.fence("drogue::linear::hypre: solution");
    }
  }

  /// Sets the values with which the next solve begins, in the unit of the solution; zero for an empty array.
  /// Blocks. Throws std::invalid_argument for an array of the wrong size and std::runtime_error if hypre
  /// fails.
  void set_guess(const List& guess) {
    if (guess.extent(0) == 0) return _solver->set_guess(nullptr);
    if (guess.extent(0) != _cells)
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    if constexpr (device::is_host<ExecutionSpace>) {
      _space.fence("drogue::linear::hypre: guess");
      _solver->set_guess(guess.data());
    } else {
      device::copy_out(_space, _solution.data(), guess, _cells);
      _space.fence("drogue::linear::hypre: guess");
      _solver->set_guess(_solution.data());
    }
  }

  /// Iterations of the last solve. Does not throw.
  [[nodiscard]] int iterations() const { return _solver->iterations(); }
  /// Ratio of the norms of the residual of the last solve and its right-hand side. Does not throw.
  [[nodiscard]] double residual() const { return _solver->residual(); }
  /// False if the last solve did not reach the tolerance. Does not throw.
  [[nodiscard]] bool converged() const { return _solver->converged(); }

 private:
  ExecutionSpace _space;
  std::size_t _cells;
  std::unique_ptr<HypreStructSolver> _solver;
  std::vector<double> _right_hand_side, _solution;  ///< on the host, of a device
};

}  // namespace drogue::linear
