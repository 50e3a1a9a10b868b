#pragma once

#include "kernels/options/contract.hpp"
#include "kernels/options/cos/exponent.hpp"

namespace drogue::options {

/// The European price and its derivatives, to 1e-12 of the strike or better, by Fourier's inversion on a
/// contour that bends away from the real axis, where the integrand falls exponentially whatever the law of
/// the jumps (Boyarchenko and Levendorskii 2019, "Sinh-acceleration"). Host only: Bessel functions of complex
/// argument are all of its work.
Price european_price(const Contract& contract, const Exponent& psi);

}  // namespace drogue::options
