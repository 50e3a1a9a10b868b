#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "kernels/flow/schemes.hpp"
#include "kernels/stepping/driver.hpp"
#include "kernels/stepping/motion_interval.hpp"

namespace drogue::flow {

/// Side of the domain: its type, and the velocity of a wall, an inflow or the fluid outside of an outflow,
/// m/s.
struct Boundary {
  BoundaryKind kind = BoundaryKind::periodic;
  std::array<double, 3> velocity = {0.0, 0.0, 0.0};
  /// Expressions of x, y, z, t for the velocity components of a wall or an inflow, m/s; none, or three. They
  /// replace `velocity`.
  std::vector<device::ExpressionProgram> velocity_expressions;
};

using stepping::Driver;

/// Parameters of a flow solver, apart from the initial state. The fluid has constant density.
struct Parameters {
  std::array<int, 3> cells = {64, 64, 64};      ///< number of cells per axis; 1: no variation along this axis
  std::array<double, 3> low = {0.0, 0.0, 0.0};  ///< lower corner of the domain, m
  std::array<double, 3> high = {1.0, 1.0, 1.0};  ///< upper corner of the domain, m
  /// Coordinates of the faces along each axis, m, ascending from `low` to `high`, one more than cells. Empty:
  /// cells of one width.
  std::array<std::vector<double>, 3> faces;
  double density = 1.0;    ///< kg/m^3
  double viscosity = 0.0;  ///< dynamic viscosity, Pa s
  /// Sides x low, x high, y low, y high, z low, z high.
  std::array<Boundary, 6> boundary;
  std::array<double, 3> body_force = {0.0, 0.0, 0.0};     ///< per volume, N/m^3
  std::array<double, 3> pressure_drop = {0.0, 0.0, 0.0};  ///< along periodic axes, from low to high side, Pa
  Advection advection = Advection::weno_z;
  TimeScheme time_scheme = TimeScheme::rk3;
  Diffusion diffusion = Diffusion::explicit_;
  Turbulence turbulence = Turbulence::none;
  double turbulence_constant = 0.0;  ///< C of the model; 0: `default_constant`
  PressureSolver pressure_solver = PressureSolver::automatic;
  double pressure_tolerance = 1e-10;  ///< of an iterative solver: relative residual
  bool external_force = false;  ///< the solver has a force field that other kernels add to before each step
  /// 1/dt = max(|u|/hx + |v|/hy + |w|/hz) / cfl + 1/dt of explicit diffusion. 0: `default_cfl`.
  /// At most `stable_cfl`.
  double cfl = 0.0;
  /// s; a positive value replaces the CFL condition. A run fails where it exceeds the stability limit: the dt
  /// of `stable_cfl`, with explicit diffusion without reserve.
  double fixed_dt = 0.0;
  double max_dt = 0.0;  ///< s; a positive value is an upper bound of dt, say for a fluid at rest
  std::int64_t max_steps = 1'000'000'000;
  /// s; until then the motion of sides that change in time is known to the choice of dt, from a division of
  /// this time that follows their expressions. Needed with such sides unless `fixed_dt` or `max_dt` is given.
  double horizon = 0.0;
  std::vector<stepping::MotionInterval> motion;  ///< other prescribed motion that limits dt, or empty
  bool watches_extremes = false;  ///< every step takes part in `Extremes`, which costs some kernels
  /// Ranks divide the cells along z alone, as they always do on devices, and not along y and z.
  bool slabs = false;
  Driver driver = Driver::automatic;
  /// Threads of a team of momentum stage and pressure correction on a device, a multiple of 32 up to 512; 0:
  /// 128.
  int block = 0;
};

}  // namespace drogue::flow
