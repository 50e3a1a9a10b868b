#pragma once

#include <complex>

namespace drogue::options {

/// log(e^z K_nu(z)) for real order and Re z > 0, continuous in z; good to 1e-14 of max(1, |value|). NaN for
/// |nu| > 1000. Temme's series and continued fraction (Temme 1975; Press et al. 2007, 6.6), which hold for
/// complex z, then upwards in the order by the ratio K_(nu+1)/K_nu, whose logarithm stays on its branch.
std::complex<double> log_bessel_k(double nu, std::complex<double> z);

}  // namespace drogue::options
