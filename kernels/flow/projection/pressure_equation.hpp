#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/prefers_transforms.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/flow/views.hpp"
#include "kernels/linear/device_communicator.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/pencil_solver.hpp"
#include "kernels/linear/poisson/slab_solver.hpp"
#if defined(DROGUE_HAVE_HYPRE)
#include "kernels/linear/poisson/hypre_pfmg.hpp"
#endif

namespace drogue::flow {

/// Pressure equation of a flow: zero normal derivative of the pressure on sides with a prescribed normal
/// velocity, zero pressure on outflows. Throws std::bad_alloc.
inline linear::PoissonProblem pressure_problem(const Parameters& parameters) {
  linear::PoissonProblem problem;
  problem.cells = parameters.cells;
  const auto end = [&](std::size_t side) {
    return parameters.boundary[side].kind == BoundaryKind::outflow ? linear::EndCondition::dirichlet
                                                                   : linear::EndCondition::neumann;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    problem.spacing[axis] = (parameters.high[axis] - parameters.low[axis]) / parameters.cells[axis];
    problem.axes[axis] = {parameters.boundary[2 * axis].kind == BoundaryKind::periodic, end(2 * axis),
                          end(2 * axis + 1)};
    problem.widths[axis] = widths(parameters, axis);
  }
  return problem;
}

/// True if the pressure equation of a flow is solved by fast transforms, and not by diagonalization. Throws
/// std::invalid_argument if `parameters` request transforms that the backend lacks for them.
template <class ExecutionSpace>
bool uses_transforms(const Parameters& parameters, const linear::PencilRanks& ranks) {
  const linear::PoissonProblem problem = pressure_problem(parameters);
  const bool can = ranks.are_slabs()
                       ? linear::SlabSolver<ExecutionSpace>::supports(problem, linear::AxisMethod::fourier)
                       : linear::FourierSolver<ExecutionSpace>::supports(problem);
  if (parameters.pressure_solver == PressureSolver::fft && !can)
    throw std::invalid_argument(
        "flow solver: this backend has fast transforms along periodic axes with equal cells alone");
  return can && prefers_transforms(parameters.pressure_solver);
}

/// Solver of the pressure equation that `Parameters::pressure_solver` selects. The constructor and the solves
/// are collective on several ranks.
template <class ExecutionSpace>
class PressureEquation {
 public:
  using Values = List<ExecutionSpace>;

  /// `in_place`: the solution replaces the right-hand side. Throws std::invalid_argument as `uses_transforms`
  /// does, and std::runtime_error if memory runs out or a library fails.
  PressureEquation(const ExecutionSpace& space, const Parameters& parameters,
                   const linear::DeviceCommunicator<ExecutionSpace>& communicator,
                   const linear::PencilRanks& ranks, bool in_place) {
    const linear::PoissonProblem problem = pressure_problem(parameters);
    const linear::RankGroup& group = communicator.group();
#if defined(DROGUE_HAVE_HYPRE)
    if (parameters.pressure_solver == PressureSolver::hypre_pfmg) {
      _name = "hypre-pfmg";
      _solver.emplace(std::in_place_type<linear::HyprePfmgSolver<ExecutionSpace>>, space, problem, group,
                      ranks, parameters.pressure_tolerance);
      return;
    }
#endif
    const bool transforms = uses_transforms<ExecutionSpace>(parameters, ranks);
    _name = transforms ? "fft" : "diagonalization";
    const auto method = transforms ? linear::AxisMethod::fourier : linear::AxisMethod::diagonalization;
    if (ranks.are_slabs())
      _solver.emplace(std::in_place_type<linear::SlabSolver<ExecutionSpace>>, space, problem, communicator,
                      ranks, method, linear::InvertedOperators::laplacian, in_place);
    else if (group.size() > 1)
      _solver.emplace(std::in_place_type<linear::PencilSolver<ExecutionSpace>>, space, problem, group, ranks,
                      method);
    else if (transforms)
      _solver.emplace(std::in_place_type<linear::FourierSolver<ExecutionSpace>>, space, problem, in_place);
    else
      _solver.emplace(std::in_place_type<linear::DiagonalizationSolver<ExecutionSpace>>, space, problem,
                      linear::InvertedOperators::laplacian);
  }

  /// Name of the solver: "fft" or "diagonalization" or "hypre-pfmg". Does not throw.
  [[nodiscard]] const char* name() const { return _name; }

  /// True if solves neither block nor allocate. Does not throw.
  [[nodiscard]] bool is_asynchronous() const {
    return std::visit([](const auto& solver) { return linear::is_asynchronous(solver); }, *_solver);
  }

  /// Last solve of an iterative solver; none for a direct one. Does not throw.
  [[nodiscard]] std::optional<PressureSolve> last_solve() const {
    return std::visit(
        [](const auto& solver) -> std::optional<PressureSolve> {
          if constexpr (requires { solver.converged(); })
            return PressureSolve{solver.iterations(), solver.residual()};
          return std::nullopt;
        },
        *_solver);
  }

  /// Lets an iterative solver, which keeps its last solution, begin with another pressure, m^2/s^2, or with
  /// zero for an empty `guess`. Does nothing for a direct one. Does not throw.
  void set_guess(const Values& guess) {
    std::visit(
        [&](auto& solver) {
          if constexpr (requires { solver.set_guess(guess); }) solver.set_guess(guess);
        },
        *_solver);
  }

  /// Enqueues a solve for the pressure, m^2/s^2, or its increment, with a right-hand side in 1/s^2. Returns
  /// false if an iterative solver, which blocks, did not converge. Throws std::runtime_error if a library
  /// fails.
  bool enqueue_solve(const Values& right_hand_side, const Values& solution) {
    return std::visit(
        [&](auto& solver) {
          solver.enqueue_solve(right_hand_side, solution);
          if constexpr (requires { solver.converged(); }) return solver.converged();
          return true;
        },
        *_solver);
  }

 private:
#if defined(DROGUE_HAVE_HYPRE)
  using Solver =
      std::variant<linear::FourierSolver<ExecutionSpace>, linear::DiagonalizationSolver<ExecutionSpace>,
                   linear::PencilSolver<ExecutionSpace>, linear::SlabSolver<ExecutionSpace>,
                   linear::HyprePfmgSolver<ExecutionSpace>>;
#else
  using Solver =
      std::variant<linear::FourierSolver<ExecutionSpace>, linear::DiagonalizationSolver<ExecutionSpace>,
                   linear::PencilSolver<ExecutionSpace>, linear::SlabSolver<ExecutionSpace>>;
#endif

  const char* _name = "";
  std::optional<Solver> _solver;  ///< never empty after the constructor
};

}  // namespace drogue::flow
