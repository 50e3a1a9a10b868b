#pragma once

#include <cstddef>
#include <vector>

#include "kernels/coupling/sheet/solver.hpp"

namespace drogue::coupling {

/// State of cloth in air on the host. A restart that restores it after the arrays and the progress of the
/// flow continues bit for bit.
struct RestartState {
  std::vector<fabric::Vector> positions, velocities;  ///< of the vertices, m and m/s
  std::vector<fabric::Vector> air_acceleration;       ///< filtered, at the vertices, m/s^2
  std::vector<fabric::Vector> forces;                 ///< on the air, N: a state with explicit coupling alone
  std::vector<fabric::Vector> defect;                 ///< filtered, m/s^2; empty unless it is a state
  std::vector<double> face_acceleration;              ///< m/s^2; empty without a sharp sheet
  BlockProgress block;
  FrameMotion frame;
};

/// Copies the state of the cloth, SI units, of a solver with so many vertices. Blocks. Throws
/// std::invalid_argument for another number of vertices.
[[nodiscard]] RestartState download_restart_state(Solver& solver, std::size_t vertices);

/// Restores the state of the cloth, SI units, after `Solver::restore`. Blocks. Throws std::invalid_argument
/// for members of the wrong length, and as `Solver::set_frame` does.
void upload_restart_state(Solver& solver, const RestartState& state);

}  // namespace drogue::coupling
