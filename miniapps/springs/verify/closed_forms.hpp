#pragma once

#include <vector>

#include "kernels/fabric/material.hpp"

/// Closed-form solutions for membranes and strings.
namespace drogue::springs_app {

/// n-th positive zero of J_m, n from 1.
double bessel_zero(int m, int n);

/// Transverse tension, N/m, of a membrane with in-plane `strain`, per length at rest. Its frequencies are
/// those of an unstretched drum with the mass per area at rest and this tension. Biquadratic springs are St
/// Venant-Kirchhoff; quadratic ones are linear in the stretch.
double drum_tension(const fabric::Material& material, double strain);

/// Nominal stress of cloth that is pulled along one axis, over modulus and strain: St Venant-Kirchhoff's is
/// E (1 + e)(e + e^2/2), other models are linear in the strain. Does not throw.
double nominal_stress_factor(fabric::Model model, double strain);

/// Frequency, Hz, of a drum: omega_mn = (j_mn / a) sqrt(T / rho).
double drum_frequency(const fabric::Material& material, double area_density, double radius, double strain,
                      int diameters, int circles);

/// Longitudinal frequency, Hz, of a string of length L, fixed at one end, with a payload M at the other: the
/// n-th root of (omega L / c) tan(omega L / c) = rho L / M, c = sqrt(EA / rho). Without payload the other end
/// is free.
double string_frequency(double axial_stiffness, double line_density, double length, double payload, int n);

/// Elongation, m, of a hanging string of length L, m, with a payload: (W L + w L^2 / 2) / EA with the weight
/// W of the payload, N, and w of the string per length, N/m.
double hanging_stretch(double axial_stiffness, double weight, double length, double payload);

/// Clamped circular membrane under a dead load q per area (Hencky 1915): centre deflection w0 = C (q a /
/// E)^(1/3) a. Returns C and the centre tension over (E q^2 a^2)^(1/3), both dimensionless.
struct Hencky {
  double deflection, tension;
};
Hencky hencky(double poisson);

/// Elastic catenary: a string of rest length `length` between two ends, under gravity.
struct Catenary {
  double span, drop;  ///< from the first end to the last along and across the horizontal, m; drop downwards
  double length;      ///< m
  double weight;      ///< per length at rest, N/m
  double axial_stiffness;  ///< N
};

/// Horizontal and downward distances, m, from the first end at the given rest lengths from it. Empty if no
/// such string exists, say between two ends one above the other.
struct CatenaryPoint {
  double along, down;
};
std::vector<CatenaryPoint> catenary_points(const Catenary& catenary, const std::vector<double>& arc);

}  // namespace drogue::springs_app
