#pragma once

#include "kernels/options/pricer.hpp"

namespace drogue::options {

/// European options by Fourier's integral, American ones by Richardson extrapolation of Bermudan ones. An
/// exercise boundary is not given, for that of Bermudan options converges too slowly, nor a profile: both
/// functions throw std::invalid_argument. Throws std::invalid_argument for settings with a mesh or steps; the
/// backend must be available.
std::unique_ptr<Pricer> create_cos_pricer(device::Backend backend, const Settings& settings);

}  // namespace drogue::options
