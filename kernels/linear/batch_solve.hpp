#pragma once

#include <vector>

namespace drogue::linear {

/// Many systems of equations of one size that live on a backend and are solved there at once. Needs an
/// initialised runtime.
class BatchSolve {
 public:
  virtual ~BatchSolve() = default;

  /// Brings back the equations that `run` begins with, and waits.
  virtual void reset() = 0;

  /// Solves them, and waits.
  virtual void run() = 0;

  /// The unknowns, those of a system side by side.
  [[nodiscard]] virtual std::vector<double> solution() = 0;
};

}  // namespace drogue::linear
