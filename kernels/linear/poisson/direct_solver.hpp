#pragma once

#include <memory>

#include "kernels/linear/device_communicator.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"

namespace drogue::linear {

/// Direct solver for the division of a problem among ranks: `SlabSolver`, `PencilSolver`, or on one rank
/// `FourierSolver` or `DiagonalizationSolver`. Copies share its arrays. Sources that use it compile none of
/// these: one translation unit per backend does.
template <class ExecutionSpace>
class DirectSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether a backend has fast transforms for a problem. Does not throw.
  static bool has_transforms(const PoissonProblem& problem, const PencilRanks& ranks);

  /// `in_place`: right-hand side and solution are always the same array, or never. Collective on the group of
  /// the communicator, which `ranks` divides; blocks. Throws std::invalid_argument for an unsupported problem
  /// and std::runtime_error if memory runs out or a library fails.
  DirectSolver(const ExecutionSpace& space, const PoissonProblem& problem,
               const DeviceCommunicator<ExecutionSpace>& communicator, const PencilRanks& ranks,
               AxisMethod method, InvertedOperators operators, bool in_place);

  /// True if solves neither block nor allocate. Does not throw.
  [[nodiscard]] bool is_asynchronous() const;

  /// Applies the inverse of the operator to the right-hand side, which it keeps unless it is in place. For
  /// the Laplacian that is in the unit of the solution per m^2. Arrays of the unknowns of this rank, x
  /// fastest. Collective. Throws std::invalid_argument for an array of the wrong size.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const;

 private:
  struct Solver;
  std::shared_ptr<Solver> _solver;
};

DROGUE_EXTERN_INSTANCES(class DirectSolver)

}  // namespace drogue::linear
