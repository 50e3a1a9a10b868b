#pragma once

#include <array>
#include <memory>
#include <vector>

#include "perf/measure/measurement.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"

/// Benchmark of pressure solvers: random right-hand sides on the grids and sides of flows.
namespace drogue::perf {

/// Solver of the pressure equation of a flow.
struct PressureMethod {
  const char* name;  ///< as in scenes
  flow::PressureSolver solver;
  double tolerance;  ///< relative residual of an iterative solver; 0: direct

  /// True for a solver whose time grows with the number of its iterations. Does not throw.
  [[nodiscard]] bool iterates() const { return tolerance > 0.0; }
};
inline constexpr PressureMethod pressure_methods[] = {
    {"fft", flow::PressureSolver::fft, 0.0},
    {"diagonalization", flow::PressureSolver::diagonalization, 0.0},
    {"hypre-pfmg", flow::PressureSolver::hypre_pfmg, 1e-10},
    {"hypre-pfmg", flow::PressureSolver::hypre_pfmg, 1e-6}};

/// Pressure equation and its solver.
struct PressureSolve {
  device::Backend backend;
  std::array<int, 3> cells;
  streams::Sides sides;
  PressureMethod method;

  /// Number of cells. Does not throw.
  [[nodiscard]] std::int64_t cell_count() const;
};

/// Largest residual over the largest term of the equation, by the Laplacian of the reference. Blocking.
double relative_residual(const PressureSolve& solve, const pressure::Solver& solver);

/// All solves of a grid that this build can do in reasonable time, by the sides and methods given.
std::vector<PressureSolve> pressure_solves(device::Backend backend, const std::array<int, 3>& cells,
                                           const std::vector<streams::Sides>& sides);

/// Case of repeated solves. `solver` receives the solver in `prepare`.
Case pressure_case(const PressureSolve& solve,
                   const std::shared_ptr<std::unique_ptr<pressure::Solver>>& solver);

}  // namespace drogue::perf
