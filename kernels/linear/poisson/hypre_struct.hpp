#pragma once

#include <memory>

#include "kernels/linear/parallel/cell_box.hpp"
#include "kernels/linear/parallel/rank_group.hpp"
#include "kernels/linear/poisson/problem.hpp"

namespace drogue::linear {

/// Conjugate gradients preconditioned by the semicoarsening multigrid PFMG of hypre (Ashby and Falgout 1996),
/// on the hosts of a group of ranks, each with a box of cells. PFMG does not coarsen a periodic axis with an
/// odd number of cells: if the coupling along it is strong, hundreds of iterations may not suffice. Only in
/// builds with DROGUE_HAVE_HYPRE.
class HypreStructSolver {
 public:
  /// Sets up the hierarchy of grids; collective, blocks. Initialises MPI if that was not done, until the
  /// program ends. `box`: cells of this rank. `tolerance`: of the 2-norm of the residual relative to that of
  /// the right-hand side, both multiplied by the volumes of the cells. Throws std::invalid_argument for a
  /// wrong number or value of widths and std::runtime_error if hypre fails.
  HypreStructSolver(const PoissonProblem& problem, const RankGroup& group, const CellBox& box,
                    double tolerance, int max_iterations);
  ~HypreStructSolver();
  HypreStructSolver(const HypreStructSolver&) = delete;
  HypreStructSolver& operator=(const HypreStructSolver&) = delete;

  /// Solves for `solution`, in its unit, with the right-hand side in that unit per m^2; arrays with one value
  /// per cell of this rank, x fastest. Begins with the last guess or solution. Collective; blocks. Throws
  /// std::runtime_error if hypre fails, but not for a solve that does not converge.
  void solve(const double* right_hand_side, double* solution);

  /// Sets the values with which the next solve begins, in the layout and unit of the solution; zero for null.
  /// Throws std::runtime_error if hypre fails.
  void set_guess(const double* guess);

  /// Iterations of the last solve. Does not throw.
  [[nodiscard]] int iterations() const;
  /// Relative residual of the last solve, dimensionless. Does not throw.
  [[nodiscard]] double residual() const;
  /// True if the residual of the last solve is at most the tolerance. Does not throw.
  [[nodiscard]] bool converged() const;

 private:
  struct Objects;
  std::unique_ptr<Objects> _objects;
};

}  // namespace drogue::linear
