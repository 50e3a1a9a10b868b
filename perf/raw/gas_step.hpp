#pragma once

#include <cstdint>

#include "perf/raw/stream.hpp"

namespace drogue::perf::raw {

/// Device-resident values that a gas step reads and reduces; SI units. The members have the meaning of those
/// of `gas::Control`.
struct GasControl {
  double dt;      ///< s
  int stopped;    ///< 1: the step does nothing
  int limited;    ///< 1: the step does nothing, because it has no limiter
  int current;    ///< buffer of U^n
  int alignment;  ///< unused
  /// Bits of the largest |u - c| and |u + c| of the result, m/s; a step raises it.
  unsigned long long speed;
  /// Least code of an inadmissible cell (`gas::encode_inadmissible`), or all bits; a step lowers it.
  unsigned long long first_inadmissible;
  double boundary_flux[4][2][3];  ///< of each stage through the left and right end
};

/// Sub-step of a Runge-Kutta method, as `gas::StageWeights`.
struct GasStage {
  double share, dt_factor;
  int out;  ///< buffer, relative to that of U^n
};

/// Arguments of a gas step.
struct GasStep {
  double* buffer[3];  ///< conserved fields, (cells, 3), each field contiguous: kg/m^3, kg/(m^2 s), J/m^3
  GasControl* control;
  GasStage stage[4];
  int stages;
  std::int64_t cells;
  int left, right;              ///< ends of the mesh: `gas::Boundary` as an integer
  int average;                  ///< at a face: `gas::FaceAverage` as an integer
  double gamma, inverse_dx;     ///< ratio of specific heats; 1/m
  int tile_cells, halo, slots;  ///< of a tile: cells that it updates, halo on either side, all of them
  int threads;                  ///< of a block
};

/// Enqueues all stages of a step as one kernel: the arithmetic, tiles, threads and shared memory of
/// `gas::StepFunctor` with the weights of Jiang and Shu in full precision, without limiter. Asynchronous.
/// Throws std::runtime_error if CUDA rejects the launch.
void launch_gas_step(const GasStep& step, Stream stream);

}  // namespace drogue::perf::raw
