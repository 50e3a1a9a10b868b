#pragma once

#include <complex>

namespace drogue::options {

/// log(e^z K_nu(z)) for real order nu and Re z > 0, continuous in z; error below 1e-14 max(1, |value|). NaN
/// for |nu| > 1000.
///
/// Temme's series and continued fraction for complex z (Temme 1975; Press et al. 2007, section 6.6), then
/// upward recurrence in the order of the ratio K_(nu+1)/K_nu, whose logarithm stays on its branch.
std::complex<double> log_bessel_k(double nu, std::complex<double> z);

}  // namespace drogue::options
