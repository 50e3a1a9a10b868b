#pragma once

#include "kernels/device/backend.hpp"

namespace drogue::testing {

/// What a test program of kernels runs on. Programs for several backends share the objects of tests that ask
/// no more.
extern const device::Backend tested_backend;

}  // namespace drogue::testing
