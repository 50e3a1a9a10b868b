#pragma once

#include "perf/ladders/weno/direct_flux.hpp"

namespace drogue::perf::ladder {

/// Fluxes of all faces of the mesh from the state of the cells ([Shi], listing 4.3): a team per tile, a
/// thread per face, cells in scratch memory.
template <class ExecutionSpace>
struct FluxFunctor {
  Fields<ExecutionSpace> state;  ///< (cells, 3)
  Fields<ExecutionSpace> flux;   ///< (cells + 1, 3)
  double gamma;

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const CellTile tile(member);
    load_tile<DirectFlux, double>(member, tile, state.data(), static_cast<std::int64_t>(state.extent(0)),
                                  gamma);
    for_tile_faces<DirectFlux, double>(member, tile, gamma, [&](int face, const ConservedVector<double>& f) {
      const std::int64_t i = tile.first + face;
      flux(i, 0) = f.rho, flux(i, 1) = f.m, flux(i, 2) = f.energy;
    });
  }
};

}  // namespace drogue::perf::ladder
