#include "kernels/reference/gas/stage.hpp"

#include "kernels/reference/gas/limiter.hpp"

namespace drogue::reference {

namespace {

Conserved mirrored(const Conserved& U) { return {U[0], -U[1], U[2]}; }

}  // namespace

std::vector<Conserved> with_ghosts(const std::vector<Conserved>& cells, const gas::Parameters& parameters) {
  const std::size_t n = cells.size();
  std::vector<Conserved> padded(n + 2 * ghost_cells);
  for (std::size_t i = 0; i < n; ++i) padded[i + ghost_cells] = cells[i];
  for (std::size_t g = 0; g < ghost_cells; ++g) {
    Conserved& left = padded[ghost_cells - 1 - g];
    Conserved& right = padded[ghost_cells + n + g];
    switch (parameters.left) {
      case gas::Boundary::outflow:
        left = cells[0];
        break;
      case gas::Boundary::reflecting:
        left = mirrored(cells[g]);
        break;
      case gas::Boundary::periodic:
        left = cells[n - 1 - g];
        break;
    }
    switch (parameters.right) {
      case gas::Boundary::outflow:
        right = cells[n - 1];
        break;
      case gas::Boundary::reflecting:
        right = mirrored(cells[n - 1 - g]);
        break;
      case gas::Boundary::periodic:
        right = cells[g];
        break;
    }
  }
  return padded;
}

StageFluxes stage_fluxes(const std::vector<Conserved>& cells, const gas::Parameters& parameters,
                         std::optional<double> lambda) {
  const double gamma = parameters.gamma;
  const SpeedBounds mesh = speed_bounds(cells, gamma);
  const std::vector<Conserved> padded = with_ghosts(cells, parameters);
  StageFluxes result;
  result.flux.resize(cells.size() + 1);
  for (std::size_t face = 0; face < result.flux.size(); ++face) {
    const std::span<const Conserved, 6> stencil(padded.data() + face, 6);
    const std::array<double, 3> alpha = splitting_alpha(parameters.splitting, mesh, stencil, gamma);
    result.flux[face] = face_flux(stencil, alpha, parameters);
    if (lambda) {
      const double fastest = speed_bounds(stencil.subspan<2, 2>(), gamma).largest;
      const Conserved low = lax_friedrichs_flux(stencil[2], stencil[3], fastest, gamma);
      const LimitedFlux limited = limit_flux(result.flux[face], low, stencil[2], stencil[3], *lambda, gamma);
      result.flux[face] = limited.flux;
      result.limited_faces += limited.limited ? 1 : 0;
    }
  }
  return result;
}

std::vector<Conserved> stage_update(const std::vector<Conserved>& start, const std::vector<Conserved>& cells,
                                    const std::vector<Conserved>& flux, double keep, double lambda) {
  std::vector<Conserved> updated(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t s = 0; s < 3; ++s)
      updated[i][s] =
          keep * start[i][s] + (1.0 - keep) * (cells[i][s] - lambda * (flux[i + 1][s] - flux[i][s]));
  return updated;
}

bool is_physical(const std::vector<Conserved>& cells, double gamma) {
  for (const Conserved& U : cells) {
    const double p = pressure(U, gamma);
    if (!(U[0] > 0.0 && p > 0.0 && std::isfinite(U[0]) && std::isfinite(p))) return false;
  }
  return true;
}

}  // namespace drogue::reference
