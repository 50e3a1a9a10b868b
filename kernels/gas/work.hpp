#pragma once

#include <cstdint>

#include "kernels/gas/parameters.hpp"
#include "kernels/gas/stage_table.hpp"

namespace drogue::gas {

/// Operations on doubles. Constants, what is computed twice, what nobody reads and signs are free.
struct Arithmetic {
  std::int64_t additions = 0, multiplications = 0;
  std::int64_t divisions = 0, roots = 0;  ///< a root and its reciprocal are one of each
  std::int64_t comparisons = 0;           ///< with maxima, minima and selections

  /// As the peak of a processor counts them: a fused multiply-add is two, a comparison none.
  [[nodiscard]] constexpr std::int64_t flops() const {
    return additions + multiplications + divisions + roots;
  }

  friend constexpr Arithmetic operator+(const Arithmetic& a, const Arithmetic& b) {
    return {a.additions + b.additions, a.multiplications + b.multiplications, a.divisions + b.divisions,
            a.roots + b.roots, a.comparisons + b.comparisons};
  }
  friend constexpr Arithmetic operator*(std::int64_t times, const Arithmetic& a) {
    return {times * a.additions, times * a.multiplications, times * a.divisions, times * a.roots,
            times * a.comparisons};
  }
  friend constexpr bool operator==(const Arithmetic&, const Arithmetic&) = default;
};

// The tables below are counted by tests/kernels/gas/gas_work_host_test.cpp, which runs the functions that
// they name.

/// One face of one stage: `stencil_speeds`, `face_eigensystem` with the arithmetic mean, `weno5_face`.
[[nodiscard]] constexpr Arithmetic face_arithmetic(Weno weno, int power) {
  switch (weno) {
    case Weno::js:
      return {230, 235, 7, 1, 15};
    case Weno::m:
      return {296, 313, 31, 1, 15};
    case Weno::teno5:
      return {278, 313, 7, 1, 51};
    case Weno::z:
      break;
  }
  return power == 1 ? Arithmetic{254, 235, 7, 1, 15} : Arithmetic{272, 289, 7, 1, 15};
}

/// One cell that a tile reads: `load_cells`.
inline constexpr Arithmetic load_arithmetic{5, 9, 1, 1, 0};

/// One cell of a stage, without U^n: `StepFunctor::update_slot`, and that of the last stage.
inline constexpr Arithmetic update_arithmetic{11, 11, 1, 1, 8};
inline constexpr Arithmetic last_update_arithmetic{9, 9, 1, 1, 10};

/// U^n, where a stage has a share of it: `combined`.
inline constexpr Arithmetic combined_arithmetic{6, 3, 0, 0, 0};

/// How a step divides the mesh.
struct Tiling {
  std::int64_t cells = 0;  ///< that a tile updates
  int halo = 0;            ///< cells that it reads beyond them on either side
  bool fused = false;      ///< all stages in one kernel; else a kernel a stage
};

/// What a step does.
struct StepWork {
  Arithmetic arithmetic;   ///< none where it is not counted
  std::int64_t bytes = 0;  ///< between the kernels and the fields: every tile reads a value once a kernel
};

/// Of one tile that updates `cells` cells. The fused form computes the halo's cells beside its own: three
/// fewer on either side with every stage.
[[nodiscard]] constexpr StepWork tile_work(const Parameters& p, const Tiling& tiling, std::int64_t cells) {
  constexpr std::int64_t state = 3 * sizeof(double);
  const StageTable table = stage_table(p.time_scheme);
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

/// Of a step of the whole mesh in FP64. Not counted: the arithmetic of a kernel a stage, of split precision,
/// of other means than the arithmetic one and of the limiter. The ends of the mesh count as its middle.
[[nodiscard]] constexpr StepWork step_work(const Parameters& p, const Tiling& tiling) {
  if (tiling.cells == 0) return {};
  const StepWork whole = tile_work(p, tiling, tiling.cells);
  const std::int64_t tiles = p.cells / tiling.cells, rest = p.cells % tiling.cells;
  StepWork work{tiles * whole.arithmetic, tiles * whole.bytes};
  if (rest > 0) {
    const StepWork last = tile_work(p, tiling, rest);
    work = {work.arithmetic + last.arithmetic, work.bytes + last.bytes};
  }
  if (p.precision != Precision::full || p.mean != Mean::arithmetic || p.positivity == Positivity::on)
    work.arithmetic = {};
  return work;
}

}  // namespace drogue::gas
