#pragma once

#include "kernels/device/backend.hpp"

namespace drogue::testing {

/// Backend of a test program of kernels. Tests that only need this value are compiled once for all backends.
extern const device::Backend tested_backend;

}  // namespace drogue::testing
