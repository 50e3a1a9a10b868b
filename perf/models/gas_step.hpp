#pragma once

#include <cstdint>

#include "kernels/gas/solver.hpp"
#include "kernels/gas/stepping/stage_table.hpp"
#include "perf/models/arithmetic.hpp"

namespace drogue::perf {

// The tables below are counted by tests/kernels/gas/gas_step_work_host_test.cpp, which runs the named
// functions.

/// Operations per face and stage: `stencil_wave_speeds`, `face_eigensystem` with the arithmetic average,
/// `weno5_face`. Does not throw.
[[nodiscard]] constexpr Arithmetic face_arithmetic(gas::Weno weno, int power) {
  switch (weno) {
    case gas::Weno::js:
      return {.additions = 230, .multiplications = 235, .divisions = 7, .roots = 1, .comparisons = 15};
    case gas::Weno::m:
      return {.additions = 296, .multiplications = 313, .divisions = 31, .roots = 1, .comparisons = 15};
    case gas::Weno::teno5:
      return {.additions = 278, .multiplications = 313, .divisions = 7, .roots = 1, .comparisons = 51};
    case gas::Weno::z:
      break;
  }
  return power == 1 ? Arithmetic{254, 235, 7, 1, 15} : Arithmetic{272, 289, 7, 1, 15};
}

/// Operations per cell that a tile loads: `load_cells`.
inline constexpr Arithmetic load_arithmetic{5, 9, 1, 1, 0};

/// Operations per cell of a stage without the U^n term, `StepFunctor::update_slot`; the last stage differs.
inline constexpr Arithmetic update_arithmetic{11, 11, 1, 1, 8};
inline constexpr Arithmetic last_update_arithmetic{9, 9, 1, 1, 10};

/// Operations per cell of a stage that includes U^n: `runge_kutta_combination`.
inline constexpr Arithmetic combined_arithmetic{6, 3, 0, 0, 0};

/// Arithmetic and memory traffic of a step.
struct StepWork {
  Arithmetic arithmetic;  ///< all zero if not counted
  /// bytes moved between kernels and fields: each tile reads each value once per kernel
  std::int64_t bytes = 0;
};

/// Work of one tile that updates `cells` cells. The fused form also computes halo cells: three fewer on
/// either side per stage. Does not throw.
[[nodiscard]] constexpr StepWork tile_work(const gas::Parameters& p, const gas::Tiling& tiling,
                                           std::int64_t cells) {
  constexpr std::int64_t state = 3 * sizeof(double);
  const gas::StageTable table = gas::stage_table(p.time_scheme);
  const std::int64_t slots = cells + 2 * tiling.halo;
  StepWork work;
  if (tiling.fused) {
    work.arithmetic = slots * load_arithmetic;
    work.bytes = state * (slots + cells);
  }
  for (int stage = 0; stage < table.stages; ++stage) {
    const bool shares = table.stage[stage].share != 1.0;
    if (!tiling.fused) {
      work.bytes += state * (slots + (shares ? cells : 0) + cells);
      continue;
    }
    const bool last = stage == table.stages - 1;
    const std::int64_t updated = slots - 2 * (stage + 1) * (tiling.halo / table.stages);
    work.arithmetic = work.arithmetic + (updated + 1) * face_arithmetic(p.weno, p.weno_power) +
                      updated * (last ? last_update_arithmetic : update_arithmetic) +
                      (shares ? updated : 0) * combined_arithmetic;
  }
  return work;
}

/// Work of one step of the whole mesh. Arithmetic is counted for the fused form in full FP64 with the
/// arithmetic average and without the limiter, and is all zero otherwise. The domain ends count as interior.
/// Does not throw.
[[nodiscard]] constexpr StepWork step_work(const gas::Parameters& p, const gas::Tiling& tiling) {
  if (tiling.cells == 0) return {};
  const StepWork whole = tile_work(p, tiling, tiling.cells);
  const std::int64_t tiles = p.cells / tiling.cells, rest = p.cells % tiling.cells;
  StepWork work{tiles * whole.arithmetic, tiles * whole.bytes};
  if (rest > 0) {
    const StepWork last = tile_work(p, tiling, rest);
    work = {work.arithmetic + last.arithmetic, work.bytes + last.bytes};
  }
  if (p.precision != gas::Precision::full || p.face_average != gas::FaceAverage::arithmetic ||
      p.positivity == gas::Positivity::on)
    work.arithmetic = {};
  return work;
}

}  // namespace drogue::perf
