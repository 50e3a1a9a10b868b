#pragma once

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

}  // namespace drogue::flow
