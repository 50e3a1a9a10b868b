#pragma once

#include <cstdint>

namespace drogue::gas {

/// Nonlinear weights of the fifth-order reconstruction.
enum class Weno {
  js,     ///< Jiang and Shu 1996
  z,      ///< Borges, Carmona, Costa and Don 2008, power p
  m,      ///< mapped, Henrick, Aslam and Powers 2005
  teno5,  ///< Fu, Hu and Adams 2016
};

/// Choice of alpha in the Lax-Friedrichs splitting F+- = (F +- alpha U) / 2.
enum class Splitting {
  lf_global,   ///< one alpha per characteristic field, the maximum over the mesh
  lf_single,   ///< one alpha for all fields, max |u|+c over the mesh
  lf_stencil,  ///< one alpha per characteristic field, the maximum over the six cells of the stencil
};

enum class TimeScheme { ssprk3, ssprk43 };

/// State at the face whose eigenvectors are used.
enum class Mean {
  arithmetic,  ///< of u and H
  conserved,   ///< of U
  roe,
};

enum class Positivity { off, on, automatic };

/// `split`: differences, central flux and update in FP64, all that is nonlinear in FP32.
enum class Precision { full, split };

/// How steps reach a device. Host backends have only loops.
enum class Driver {
  automatic,   ///< persistent where mesh, splitting and limiter allow it, else graph
  plain,       ///< kernels one by one
  graph,       ///< the kernels of a step as one recorded graph
  persistent,  ///< many steps in one launch of teams that all run at once
  stages,      ///< a recorded graph of a kernel a stage, which other splittings than lf_stencil always have
};

enum class Boundary { outflow, reflecting, periodic };

/// Everything a gas solver needs to know but the initial state.
struct Parameters {
  double gamma = 1.4;        ///< ratio of specific heats, > 1
  std::int64_t cells = 200;  ///< 8 .. 2^28
  double x_min = -1.0;       ///< left end of the domain, m
  double x_max = 1.0;        ///< right end of the domain, m
  Boundary left = Boundary::outflow;
  Boundary right = Boundary::outflow;
  Weno weno = Weno::z;
  int weno_power = 1;  ///< Z only: 1 or 2
  Splitting splitting = Splitting::lf_stencil;
  TimeScheme time_scheme = TimeScheme::ssprk3;
  Mean mean = Mean::arithmetic;
  Positivity positivity = Positivity::automatic;
  Precision precision = Precision::full;
  double cfl = 0.6;       ///< dt = cfl dx / max(|u|+c)
  int ramp_steps = 20;    ///< step k < ramp_steps takes 0.1 + 0.9 k / ramp_steps of it
  double fixed_dt = 0.0;  ///< s; > 0 replaces the CFL condition
  std::int64_t max_steps = 1'000'000;
  int block = 0;  ///< threads a team on a device, cells a tile elsewhere; 0: the backend's default
  Driver driver = Driver::automatic;
  bool pinned = false;  ///< seed mode: what is copied lies in page-locked host memory, where a backend has it
};

}  // namespace drogue::gas
