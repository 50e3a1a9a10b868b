#pragma once

#include <cstdint>

#include "kernels/stepping/driver.hpp"

namespace drogue::gas {

/// Nonlinear weights of the fifth-order reconstruction.
enum class Weno {
  js,     ///< Jiang and Shu 1996
  z,      ///< Borges, Carmona, Costa and Don 2008, with the exponent `weno_power`
  m,      ///< mapped weights, Henrick, Aslam and Powers 2005
  teno5,  ///< Fu, Hu and Adams 2016
};

/// Dissipation coefficient alpha of the Lax-Friedrichs splitting F+- = (F +- alpha U) / 2.
enum class Splitting {
  lf_global,   ///< one alpha per characteristic field: the maximum over the mesh
  lf_single,   ///< one alpha for all fields: max |u|+c over the mesh
  lf_stencil,  ///< one alpha per characteristic field: the maximum over the six cells of the stencil
};

enum class TimeScheme { ssprk3, ssprk43 };

/// Average of the two cells beside a face at which the eigenvectors are evaluated.
enum class FaceAverage {
  arithmetic,  ///< of u and H
  conserved,   ///< of the conserved variables U
  roe,
};

enum class Positivity { off, on, automatic };

/// Floating-point precision. `split`: differences, central flux and update in FP64, nonlinear terms in FP32.
enum class Precision { full, split };

using stepping::Driver;

enum class Boundary { outflow, reflecting, periodic };

/// Parameters of a gas solver, apart from the initial state.
struct Parameters {
  double gamma = 1.4;        ///< ratio of specific heats, > 1
  std::int64_t cells = 200;  ///< number of cells, 8 .. 2^28
  double x_min = -1.0;       ///< left end of the domain, m
  double x_max = 1.0;        ///< right end of the domain, m
  Boundary left = Boundary::outflow;
  Boundary right = Boundary::outflow;
  Weno weno = Weno::z;
  int weno_power = 1;  ///< exponent of the Z weights: 1 or 2
  Splitting splitting = Splitting::lf_stencil;
  TimeScheme time_scheme = TimeScheme::ssprk3;
  FaceAverage face_average = FaceAverage::arithmetic;
  Positivity positivity = Positivity::automatic;
  Precision precision = Precision::full;
  double cfl = 0.6;       ///< Courant number: dt = cfl dx / max(|u|+c)
  int ramp_steps = 20;    ///< step k < ramp_steps scales dt by 0.1 + 0.9 k / ramp_steps
  double fixed_dt = 0.0;  ///< s; a positive value replaces the CFL condition and is never halved
  std::int64_t max_steps = 1'000'000;
  int block = 0;  ///< threads per team on a device, cells per tile on a host; 0: the default of the backend
  /// `automatic` and `persistent` need a mesh that fits the shared memory, lf_stencil, and no limiter from
  /// the start. Splittings other than lf_stencil always run one kernel per stage.
  Driver driver = Driver::automatic;
  /// baseline solver: use page-locked host memory for transfers, on backends that have it
  bool pinned = false;
};

}  // namespace drogue::gas
