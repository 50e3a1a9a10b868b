#pragma once

#include <filesystem>
#include <string>

#include "kernels/gas/solver.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

/// All that a restarted run needs to go on with the same bits.
struct RestartState {
  gas::RestartState resume;
  gas::HistoryRow initial;  ///< totals at the start, for the conservation check
};

/// Names the mesh, gas and scheme of a scene; output, end time and checks may change between a run and its
/// continuation.
std::string scene_fingerprint(GasScene scene);

/// Writes the conserved fields `u` and `state` atomically. `touched` is read from the solver if the limiter
/// may have acted.
void write_restart(const std::filesystem::path& file, const GasScene& scene, gas::Solver& solver,
                   const gas::ConstConservedFields& u, const RestartState& state);

/// Uploads what `write_restart` wrote and returns its state; the solver still has to be told
/// (`Solver::restore`). Throws Failure(io_error) for a file that is damaged or of another mesh, gas or
/// scheme.
RestartState read_restart(const std::filesystem::path& file, const GasScene& scene, gas::Solver& solver);

}  // namespace drogue::gas_app
