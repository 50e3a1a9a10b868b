#pragma once

#include "kernels/options/contract.hpp"
#include "kernels/options/cos/characteristic_exponent.hpp"

namespace drogue::options {

/// European price and Greeks, to 1e-12 of the strike or better, by Fourier inversion on a deformed contour.
///
/// The contour bends away from the real axis, so that the integrand decays exponentially for any jump
/// distribution (Boyarchenko and Levendorskii 2019, "Sinh-acceleration"). Runs on the host, since Bessel
/// functions of complex argument dominate its cost. Does not throw.
Price european_price(const Contract& contract, const CharacteristicExponent& psi);

}  // namespace drogue::options
