#pragma once

#include "kernels/gas/stepping/stage_table.hpp"
#include "perf/ladders/weno/weno_rung.hpp"

namespace drogue::perf::ladder {

/// A Runge-Kutta stage in one kernel: fluxes stay in scratch memory. `Flux` computes states of cells and
/// fluxes of faces on numbers of type `R`.
template <class ExecutionSpace, class Flux, class R>
struct StageFunctor {
  Fields<ExecutionSpace> start, in, out;  ///< (cells, 3): U^n, input and result of the stage
  double gamma, dt_over_dx, share;

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    constexpr int lanes = device::Access<R>::lanes;
    const auto cells = static_cast<std::int64_t>(in.extent(0));
    const CellTile tile(member);
    load_tile<Flux, R>(member, tile, in.data(), cells, gamma);
    for_tile_faces<Flux, R>(member, tile, gamma,
                            [&](int face, const ConservedVector<R>& f) { tile.store_flux(face, f); });
    member.team_barrier();
    for (int i = member.team_rank() * lanes; i < tile_cells; i += member.team_size() * lanes) {
      const CellState<R> now = tile.cell<R>(tile_ghosts + i);
      const ConservedVector<R> left = tile.flux<R>(i), right = tile.flux<R>(i + 1);
      update(0, cells, tile.first + i, now.rho, left.rho - right.rho);
      update(1, cells, tile.first + i, now.m, left.m - right.m);
      update(2, cells, tile.first + i, now.energy, left.energy - right.energy);
    }
  }

  KOKKOS_FUNCTION void update(int k, std::int64_t cells, std::int64_t i, const R& now,
                              const R& difference) const {
    const R u_n = device::Access<R>::load(start.data() + k * cells + i);
    device::Access<R>::store(out.data() + k * cells + i, u_n + share * (now + dt_over_dx * difference - u_n));
  }
};

/// Numbers that a thread computes at once: packs of cells on a host.
template <class ExecutionSpace>
using Packed = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Rungs with a kernel per stage of SSP-RK3. `Bounds`: launch bounds.
template <class ExecutionSpace, class Flux, class R = double, class Bounds = Kokkos::LaunchBounds<>>
class StageRung final : public WenoRung<ExecutionSpace> {
 public:
  StageRung(const WenoProblem& problem, const char* label)
      : WenoRung<ExecutionSpace>(problem), _label(label) {}

 protected:
  void step() override {
    constexpr gas::StageTable table = gas::stage_table(gas::TimeScheme::ssprk3);
    for (int s = 0; s < table.stages; ++s) {
      const gas::StageWeights& w = table.stage[s];
      launch_tiles<Bounds>(this->space(), _label, this->problem().cells(),
                           StageFunctor<ExecutionSpace, Flux, R>{.start = this->buffer(0),
                                                                 .in = this->buffer(w.in),
                                                                 .out = this->buffer(w.out),
                                                                 .gamma = this->problem().gamma(),
                                                                 .dt_over_dx = this->problem().dt_over_dx(),
                                                                 .share = w.share});
    }
    this->advance_buffers(table.stage[table.stages - 1].out);
  }

 private:
  const char* _label;
};

}  // namespace drogue::perf::ladder
