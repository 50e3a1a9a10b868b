#pragma once

#include <array>
#include <vector>

#include "perf/measure/measurement.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"

/// Benchmark of pressure solvers: random right-hand sides on the grids and sides of flows.
namespace drogue::perf {

/// Solver of the pressure equation of a flow.
struct PressureMethod {
  const char* name;  ///< as in scenes; with "slabs-" those of several ranks of a device, on one
  flow::PressureSolver solver;
  double tolerance;       ///< relative residual of an iterative solver; 0: direct
  bool in_slabs = false;  ///< as `pressure::create_solver`

  /// True for a solver whose time grows with the number of its iterations. Does not throw.
  [[nodiscard]] bool iterates() const { return tolerance > 0.0; }
};
inline constexpr PressureMethod pressure_methods[] = {
    {"fft", flow::PressureSolver::fft, 0.0},
    {"diagonalization", flow::PressureSolver::diagonalization, 0.0},
    {"slabs-fft", flow::PressureSolver::fft, 0.0, true},
    {"slabs-diagonalization", flow::PressureSolver::diagonalization, 0.0, true},
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

/// All solves of a grid with the given sides that this build can do; iterative ones up to a number of cells.
std::vector<PressureSolve> pressure_solves(device::Backend backend, const std::array<int, 3>& cells,
                                           const std::vector<streams::Sides>& sides,
                                           std::int64_t most_iterated_cells);

/// Case of repeated solves. Does not throw.
Case pressure_case(const PressureSolve& solve);

}  // namespace drogue::perf
