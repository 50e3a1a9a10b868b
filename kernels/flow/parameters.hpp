#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "kernels/stepping/driver.hpp"
#include "kernels/stepping/motion_interval.hpp"

namespace drogue::flow {

/// Discretisation of the advective fluxes.
enum class Advection {
  central,  ///< second-order central, conserves kinetic energy in space
  weno_js,  ///< fifth-order upwind-biased, weights of Jiang and Shu 1996
  weno_z,   ///< fifth-order upwind-biased, weights of Borges, Carmona, Costa and Don 2008
};

/// Whether the fluxes of a scheme are biased to the side that fluid comes from, so that on outflows they are
/// of first order and upwind.
[[nodiscard]] constexpr bool is_upwind(Advection scheme) {
  switch (scheme) {
    case Advection::central:
      return false;
    case Advection::weno_js:
    case Advection::weno_z:
      return true;
  }
  return true;
}

/// Explicit time integration of advection, and of diffusion if that is explicit.
enum class TimeScheme {
  ab2,  ///< Adams-Bashforth of second order with variable dt; one projection per step
  rk3,  ///< third-order strong-stability-preserving Runge-Kutta (Shu and Osher 1988); three projections
};

/// Time integration of viscous stresses.
enum class Diffusion {
  explicit_,       ///< as advection; limits dt to h^2 / (4 d nu) in d dimensions, 2.5 times that with RK3
  crank_nicolson,  ///< implicit, second order; needs AB2. Does not limit dt
};

/// Model of unresolved scales.
enum class Turbulence {
  none,         ///< implicit large-eddy simulation by the dissipation of the upwind-biased fluxes
  smagorinsky,  ///< Smagorinsky 1963, eq. (4.30): nu_t = (C delta)^2 |S|
  vreman,       ///< Vreman 2004, eq. (5): vanishes in laminar shear
};

/// Solver of the pressure equation.
enum class PressureSolver {
  automatic,        ///< the faster direct solver of the backend; in the preset exact, diagonalization
  fft,              ///< by fast transforms along all axes
  diagonalization,  ///< by products with the matrices of eigenvectors, Lynch, Rice and Thomas 1964
  hypre_pfmg,       ///< conjugate gradients of hypre, preconditioned by its semicoarsening multigrid
};

/// Type of a side of the domain.
enum class BoundaryKind {
  periodic,
  slip,    ///< no flow through the side, no shear stress
  wall,    ///< velocity of the wall, no slip
  inflow,  ///< prescribed velocity
  /// The normal velocity obeys its momentum equation, and there is no shear stress; tangential velocities
  /// leave unchanged. Zero pressure. Where fluid enters, it has the tangential velocity and the total
  /// pressure of the fluid outside.
  outflow,
  neighbour,  ///< other ranks hold the cells beyond; only inside a solver, no side of a domain
};

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

/// Largest CFL number of a time scheme. RK3 is stable up to 1.43 with fifth-order upwind derivatives and 1.73
/// with central ones. AB2 amplifies some wave at any CFL number without viscosity, at 0.7 by 15 percent in
/// each step with central derivatives. Does not throw.
[[nodiscard]] constexpr double stable_cfl(TimeScheme scheme) { return scheme == TimeScheme::rk3 ? 1.4 : 0.7; }

/// Dimensionless constant of a turbulence model unless `Parameters::turbulence_constant` is given. Does not
/// throw.
[[nodiscard]] constexpr double default_constant(Turbulence model) {
  return model == Turbulence::smagorinsky ? 0.17 : 0.07;
}

/// Dimensionless CFL number of a time scheme unless `Parameters::cfl` is given. Does not throw.
[[nodiscard]] constexpr double default_cfl(TimeScheme scheme) {
  return scheme == TimeScheme::rk3 ? 1.0 : 0.5;
}

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
