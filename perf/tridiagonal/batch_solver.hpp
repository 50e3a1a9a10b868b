#pragma once

#include <vector>

namespace drogue::perf::tridiagonal {

/// Batch of tridiagonal systems of one size on a backend. The numbers are dimensionless. Requires an
/// initialised runtime. No function throws, but std::runtime_error for a CUDA error.
class BatchSolver {
 public:
  virtual ~BatchSolver() = default;

  /// Restores the equations if `solve` overwrote them. Blocking.
  virtual void reset() = 0;

  /// Solves all systems. Blocking.
  virtual void solve() = 0;

  /// Solves all systems and returns the time on the device (`device_time`), s; 0 on a host, which does not
  /// solve. Blocking.
  virtual double timed_solve() = 0;

  /// Unknowns (batch, unknowns), row by row. Blocking.
  [[nodiscard]] virtual std::vector<double> solution() = 0;
};

}  // namespace drogue::perf::tridiagonal
