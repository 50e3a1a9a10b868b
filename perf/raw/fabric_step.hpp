#pragma once

#include <cstdint>

#include "perf/raw/stream.hpp"

namespace drogue::perf::raw {

/// Adjacency in sliced ELLPACK format, as `fabric::SlicedEll`. A table of values has one column after
/// another.
struct SlicedEll {
  const int *first, *neighbour;
  const double* value;  ///< may be null
  std::int64_t slots;   ///< rows of `value`
};

/// Device-resident step counter and record of the first failure, as `stepping::StepMonitor`.
struct StepCount {
  std::int64_t* steps;                ///< two entries
  unsigned long long* first_failure;  ///< least code of a vertex that is not finite, or all bits
};

/// Arguments of a Runge-Kutta step of a sheet of St Venant-Kirchhoff triangles; SI units. Points have three
/// columns of `vertices` numbers, which is a multiple of 32.
struct FabricStep {
  SlicedEll ring, springs;
  const double *rest, *inverse_mass;  ///< m; 1/kg
  const std::uint8_t* fixed_axes;     ///< 1 x, 2 y, 4 z
  const double* load;                 ///< N; may be null
  double lambda, two_g;               ///< Lame's first constant and twice the shear modulus, N/m
  double gravity[3], damping;         ///< m/s^2; 1/s
  double *x, *v;                      ///< m, m/s; of step n, overwritten by the second half
  double *third, *fourth;             ///< m, positions of these stages
  double* velocity[2];                ///< m/s, of the second and third stage
  StepCount count;
  double dt;  ///< s
  int vertices;
};

/// Enqueues the two kernels of a step: the arithmetic, layout and threads of
/// `fabric::RungeKuttaHalfFunctor`. Asynchronous. Throws std::runtime_error if CUDA rejects a launch.
void launch_fabric_step(const FabricStep& step, Stream stream);

}  // namespace drogue::perf::raw
