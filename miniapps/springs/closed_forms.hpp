#pragma once

#include <vector>

#include "kernels/fabric/parameters.hpp"

/// What theory says of cloth and strings.
namespace drogue::springs_app {

/// The n-th positive zero of J_m, n from 1.
double bessel_zero(int m, int n);

/// Transverse tension of a membrane stretched by `strain` in its plane, per length at rest: its frequencies
/// are those of an unstretched drum of the mass per area at rest with this tension. N/m. Biquadratic springs
/// are St Venant-Kirchhoff; quadratic ones are linear in the stretch.
double drum_tension(const fabric::Material& material, double strain);

/// omega_mn = (j_mn / a) sqrt(T / rho), as a frequency, Hz.
double drum_frequency(const fabric::Material& material, double area_density, double radius, double strain,
                      int diameters, int circles);

/// A string of length L held at one end, with a payload M at the other: the n-th root of
/// (omega L / c) tan(omega L / c) = rho L / M, c = sqrt(EA / rho); without payload its ends are free and
/// fixed. Hz.
double string_frequency(double axial_stiffness, double line_density, double length, double payload, int n);

/// How much a string of length L (m) grows that hangs with a payload: (W L + w L^2 / 2) / EA, W the payload's
/// weight (N), w that of the string per length (N/m).
double hanging_stretch(double axial_stiffness, double weight, double length, double payload);

/// w0 = C (q a / E)^(1/3) a: deflection at the centre of a clamped circular membrane under a dead load q per
/// area (Hencky 1915). Here is C, and with it the tension at the centre over (E q^2 a^2)^(1/3).
struct Hencky {
  double deflection, tension;
};
Hencky hencky(double poisson);

/// The elastic catenary: a string of length `length` at rest between two ends, under gravity.
struct Catenary {
  double span, drop;  ///< from the first end to the last along and across the horizontal, m; drop downwards
  double length;      ///< m
  double weight;      ///< per length at rest, N/m
  double axial_stiffness;  ///< N
};

/// Horizontal and downward distance from the first end, at the given lengths at rest from it; empty where no
/// such string hangs, say between two ends one above the other.
struct CatenaryPoint {
  double along, down;
};
std::vector<CatenaryPoint> catenary_points(const Catenary& catenary, const std::vector<double>& arc);

}  // namespace drogue::springs_app
