#include "kernels/linear/poisson/direct_solver.hpp"

#include <variant>

#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/pencil_solver.hpp"
#include "kernels/linear/poisson/slab_solver.hpp"

namespace drogue::linear {

template <class ExecutionSpace>
struct DirectSolver<ExecutionSpace>::Solver {
  template <class... Arguments>
  explicit Solver(const Arguments&... arguments) : of_method(arguments...) {}

  std::variant<FourierSolver<ExecutionSpace>, DiagonalizationSolver<ExecutionSpace>,
               PencilSolver<ExecutionSpace>, SlabSolver<ExecutionSpace>>
      of_method;
};

template <class ExecutionSpace>
bool DirectSolver<ExecutionSpace>::has_transforms(const PoissonProblem& problem, const PencilRanks& ranks) {
  return ranks.are_slabs() ? SlabSolver<ExecutionSpace>::supports(problem, AxisMethod::fourier)
                           : FourierSolver<ExecutionSpace>::supports(problem);
}

template <class ExecutionSpace>
DirectSolver<ExecutionSpace>::DirectSolver(const ExecutionSpace& space, const PoissonProblem& problem,
                                           const DeviceCommunicator<ExecutionSpace>& communicator,
                                           const PencilRanks& ranks, AxisMethod method,
                                           InvertedOperators operators, bool in_place) {
  const RankGroup& group = communicator.group();
  if (ranks.are_slabs())
    _solver = std::make_shared<Solver>(std::in_place_type<SlabSolver<ExecutionSpace>>, space, problem,
                                       communicator, ranks, method, operators, in_place);
  else if (group.size() > 1)
    _solver = std::make_shared<Solver>(std::in_place_type<PencilSolver<ExecutionSpace>>, space, problem,
                                       group, ranks, method);
  else if (method == AxisMethod::fourier)
    _solver =
        std::make_shared<Solver>(std::in_place_type<FourierSolver<ExecutionSpace>>, space, problem, in_place);
  else
    _solver = std::make_shared<Solver>(std::in_place_type<DiagonalizationSolver<ExecutionSpace>>, space,
                                       problem, operators);
}

template <class ExecutionSpace>
bool DirectSolver<ExecutionSpace>::is_asynchronous() const {
  return std::visit([](const auto& solver) { return linear::is_asynchronous(solver); }, _solver->of_method);
}

template <class ExecutionSpace>
void DirectSolver<ExecutionSpace>::enqueue_solve(const List& right_hand_side, const List& solution,
                                                 const SpectralOperator& spectral_operator) const {
  std::visit([&](auto& solver) { solver.enqueue_solve(right_hand_side, solution, spectral_operator); },
             _solver->of_method);
}

template class DirectSolver<DROGUE_INSTANCE_SPACE>;

}  // namespace drogue::linear
