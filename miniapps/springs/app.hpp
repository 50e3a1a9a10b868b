#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/mini_app_options.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"

namespace drogue::springs_app {

/// Starts Kokkos with its options. Throws Failure(usage) where it would not start.
std::unique_ptr<device::Runtime> start_kokkos(const std::vector<std::string>& arguments);

/// The backend an option means, present and compiled in. Throws Failure(no_backend).
device::Backend choose_backend(const std::string& wanted);

/// Does what the command line asks for. Throws Failure; the exit code of an interrupted run is returned.
ExitCode run_app(const MiniAppOptions& options);

}  // namespace drogue::springs_app
