#pragma once

#include <cstdlib>

#include "kernels/linear/poisson/hypre_struct.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace drogue::testing {

/// Starts MPI by a first small solver, before a test: the plugins of Open MPI never free some of their
/// memory, which would count as a leak of the test.
inline void start_hypre() {
#if defined(__SANITIZE_ADDRESS__)
  const __lsan::ScopedDisabler disabler;
#endif
  linear::PoissonProblem problem;
  problem.cells = {4, 4, 4};
  const linear::HypreStructSolver solver(problem, {}, {{0, 0, 0}, problem.cells}, 1e-6, 1);
#if defined(__SANITIZE_ADDRESS__)
  // Runs before the handler that the solver registered, which ends MPI.
  std::atexit(__lsan_disable);
#endif
}

}  // namespace drogue::testing
