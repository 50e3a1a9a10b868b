#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/face_flux.hpp"

namespace drogue::reference {

/// Cells on each side of the mesh that the stencil of the outermost faces needs.
inline constexpr std::size_t ghost_cells = 3;

/// The n cells with three ghost cells on each side: copies of the last cell (outflow), mirror images
/// (reflecting), or the cells of the other end (periodic).
[[nodiscard]] std::vector<Conserved> with_ghosts(const std::vector<Conserved>& cells,
                                                 const gas::Parameters& parameters);

struct StageFluxes {
  std::vector<Conserved> flux;     ///< n+1 faces, left to right
  std::int64_t limited_faces = 0;  ///< faces where the limiter acted
};

/// Fluxes at the n+1 faces of the mesh. With `lambda` (the stage's dt/dx) they are limited for positivity.
[[nodiscard]] StageFluxes stage_fluxes(const std::vector<Conserved>& cells, const gas::Parameters& parameters,
                                       std::optional<double> lambda);

/// Shu-Osher form of one stage: keep * start + (1 - keep) * (cells - lambda * difference of fluxes).
[[nodiscard]] std::vector<Conserved> stage_update(const std::vector<Conserved>& start,
                                                  const std::vector<Conserved>& cells,
                                                  const std::vector<Conserved>& flux, double keep,
                                                  double lambda);

/// True if density and pressure are positive and all is finite.
[[nodiscard]] bool is_physical(const std::vector<Conserved>& cells, double gamma);

}  // namespace drogue::reference
