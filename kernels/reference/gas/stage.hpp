#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/face_flux.hpp"

namespace drogue::reference {

/// Ghost cells per side, as the stencil of the outermost faces requires.
inline constexpr std::size_t ghost_cells = 3;

/// The n cells with three ghost cells per side: copies of the last cell (outflow), mirror images
/// (reflecting), or the cells of the other end (periodic). Throws `std::bad_alloc`.
[[nodiscard]] std::vector<Conserved> with_ghosts(const std::vector<Conserved>& cells,
                                                 const gas::Parameters& parameters);

struct StageFluxes {
  std::vector<Conserved> flux;     ///< n+1 faces, left to right
  std::int64_t limited_faces = 0;  ///< faces that the limiter changed
};

/// Fluxes at the n+1 faces of the mesh, SI units. Given `lambda` (dt/dx of the stage, s/m), they are limited
/// for positivity. Throws `std::bad_alloc`.
[[nodiscard]] StageFluxes stage_fluxes(const std::vector<Conserved>& cells, const gas::Parameters& parameters,
                                       std::optional<double> lambda);

/// Shu-Osher form of one stage: keep * start + (1 - keep) * (cells - lambda * flux difference), `lambda` in
/// s/m. Throws `std::bad_alloc`.
[[nodiscard]] std::vector<Conserved> stage_update(const std::vector<Conserved>& start,
                                                  const std::vector<Conserved>& cells,
                                                  const std::vector<Conserved>& flux, double keep,
                                                  double lambda);

/// True if density and pressure are positive and all values are finite. Does not throw.
[[nodiscard]] bool is_physical(const std::vector<Conserved>& cells, double gamma);

}  // namespace drogue::reference
