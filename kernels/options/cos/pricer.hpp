#pragma once

#include "kernels/options/pricer.hpp"

namespace drogue::options {

/// Creates a pricer for the method `cos`: European options by Fourier inversion, American ones by Richardson
/// extrapolation of Bermudan ones. `backend` must be available. Throws std::invalid_argument for settings
/// with a mesh, or with steps that are no multiple of 8.
///
/// `boundary` and `profile` of the pricer throw std::invalid_argument: boundaries of Bermudan options
/// converge too slowly, and every spot of a profile would be a solve of its own.
std::unique_ptr<Pricer> create_cos_pricer(device::Backend backend, const Settings& settings);

}  // namespace drogue::options
