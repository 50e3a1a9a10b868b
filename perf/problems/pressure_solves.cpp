#include "perf/problems/pressure_solves.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "kernels/reference/linear/laplacian.hpp"

namespace drogue::perf {

std::int64_t PressureSolve::cell_count() const {
  return static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2];
}

double relative_residual(const PressureSolve& solve, const pressure::Solver& solver) {
  const linear::PoissonProblem problem = streams::pressure_problem(solve.cells, solve.sides);
  reference::CellBox box{problem.cells, problem.spacing, {}};
  double squares = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const linear::AxisConditions& ends = problem.axes[axis];
    const auto end = [&](linear::EndCondition condition) {
      if (ends.periodic) return reference::End::periodic;
      return condition == linear::EndCondition::dirichlet ? reference::End::dirichlet
                                                          : reference::End::neumann;
    };
    box.ends[axis] = {end(ends.low), end(ends.high)};
    squares += 4.0 / (problem.spacing[axis] * problem.spacing[axis]);
  }
  const std::vector<double> p = solver.solution(), image = reference::laplacian(box, p);
  double difference = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    difference = std::max(difference, std::abs(image[i] - solver.right_hand_side()[i]));
    largest = std::max(largest, std::abs(p[i]));
  }
  return difference / (squares * largest);
}

namespace {

/// The larger residual of another solve of either right-hand side: which of them the samples ended with
/// depends on their number.
double largest_residual(const PressureSolve& solve, pressure::Solver& solver) {
  const auto residual = [&] {
    solver.solve(1);
    return relative_residual(solve, solver);
  };
  const double first = residual(), second = residual();
  return std::isnan(first) || first > second ? first : second;
}

}  // namespace

std::vector<PressureSolve> pressure_solves(device::Backend backend, const std::array<int, 3>& cells,
                                           const std::vector<streams::Sides>& sides,
                                           std::int64_t most_iterated_cells) {
  std::vector<PressureSolve> solves;
  for (const streams::Sides of_box : sides)
    for (const PressureMethod& method : pressure_methods) {
      const PressureSolve solve{backend, cells, of_box, method};
      const bool slow = method.iterates() && solve.cell_count() > most_iterated_cells;
      if (!slow && pressure::is_available(backend, streams::pressure_problem(cells, of_box), method.solver,
                                          method.in_slabs))
        solves.push_back(solve);
    }
  return solves;
}

Case pressure_case(const PressureSolve& solve) {
  const PressureMethod& method = solve.method;
  const auto cells = static_cast<long>(solve.cell_count());
  const long pairs = solve.backend == device::Backend::cuda ? std::clamp(100'000'000L / cells, 3L, 100L)
                                                            : std::clamp(1'000'000L / cells, 1L, 50L);
  // Solves alternate between two right-hand sides, of which an iterative solver may need more iterations for
  // one: its samples alternate too.
  const long solves = method.iterates() ? 1 : 2 * pairs;
  const std::string name(device::name(solve.backend));
  const std::string sides = streams::name(solve.sides);
  // A tolerance of 1e-6 is a variant of the usual one.
  const std::string variant =
      std::string(method.name) + "/" + sides + (method.tolerance > 1e-8 ? "/1e-6" : "");
  return {.name = "flow-pressure/" + name + "/" + streams::text(solve.cells) + "/" + variant,
          .backend = solve.backend,
          .unit_of_work = "solve",
          .bound = method.iterates() ? "memory, and copies to the host"
                                     : "memory; FP64 tensor cores of matrix products",
          // The residual of hypre is relative to the right-hand side, in the 2-norm.
          .tolerance = method.iterates() ? 1e3 * method.tolerance : 1e-13,
          .prepare =
              [=] {
                const std::shared_ptr<pressure::Solver> solver = pressure::create_solver(
                    solve.backend, streams::pressure_problem(solve.cells, solve.sides), method.solver,
                    std::max(method.tolerance, 1e-10), method.in_slabs);
                return Sample{.reset = [] {},
                              .work =
                                  [=] {
                                    solver->solve(solves);
                                    return solves;
                                  },
                              .error = [=] { return largest_residual(solve, *solver); },
                              .complete = [=](Facts& facts) { facts.iterations = solver->iterations(); }};
              },
          .facts = {.cells = solve.cell_count(), .variant = variant}};
}

}  // namespace drogue::perf
