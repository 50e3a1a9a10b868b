#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Number of cells per transfer; bounds the host memory.
inline constexpr std::int64_t chunk_cells = std::int64_t{1} << 18;

/// Calls `visit(first, count)` for consecutive chunks of the mesh.
void for_chunks(std::int64_t cells, const std::function<void(std::int64_t first, std::size_t count)>& visit);

/// Evaluates the initial state of the scene and uploads it. Blocks.
void upload_initial_state(gas::Solver& solver, const GasScene& scene);

/// Density, velocity and pressure of one cell of a conserved state.
inline Primitive primitive(const gas::ConstConservedFields& u, std::size_t i, double gamma) {
  const double velocity = u.momentum[i] / u.rho[i];
  return {u.rho[i], velocity, (gamma - 1.0) * (u.energy[i] - 0.5 * u.momentum[i] * velocity)};
}

/// Visits every cell of the solver's state in order. Blocks.
void for_cells(gas::Solver& solver, const gas::Parameters& parameters,
               const std::function<void(std::int64_t cell, const Primitive& state)>& visit);

}  // namespace drogue::gas_app
