#pragma once

#include <cstdint>

#include "perf/models/arithmetic.hpp"

namespace drogue::perf {

/// `options::lanes_of`, whose header needs Kokkos. Does not throw.
[[nodiscard]] constexpr int option_lanes(int mesh) { return mesh == 64 || mesh == 128 ? 16 : 32; }

/// Operations per step of the march of one option (`options::step`) with positive slopes, without added
/// diffusion and split exercise, as a host runs it; all zero for meshes without a count. Does
/// not throw. tests/kernels/options/options_work_host_test.cpp counts them.
[[nodiscard]] constexpr Arithmetic options_step_arithmetic(int mesh, int lanes) {
  if (lanes == 16 && mesh == 32) return {.additions = 1452, .multiplications = 1459, .comparisons = 90};
  if (lanes == 16 && mesh == 64) return {.additions = 4884, .multiplications = 4895, .comparisons = 150};
  if (lanes == 16 && mesh == 128) return {.additions = 6384, .multiplications = 4236, .comparisons = 292};
  if (lanes == 32 && mesh == 128) return {.additions = 18081, .multiplications = 18094, .comparisons = 341};
  if (lanes == 32 && mesh == 256) return {.additions = 14173, .multiplications = 9099, .comparisons = 627};
  return {};
}

/// Operations of the marches of one option on a mesh and on the coarser one; all zero if one of them has no
/// count. The set-up of an option (extent of the grid, weights of jumps, table of steps) is not counted,
/// since its work depends on the parameters. Does not throw.
[[nodiscard]] constexpr Arithmetic options_march_arithmetic(int mesh, int steps) {
  const int lanes = option_lanes(mesh);
  const Arithmetic fine = options_step_arithmetic(mesh, lanes),
                   coarse = options_step_arithmetic(mesh / 2, lanes);
  if (fine == Arithmetic{} || coarse == Arithmetic{}) return {};
  return steps * fine + (steps / 2) * coarse;
}

}  // namespace drogue::perf
