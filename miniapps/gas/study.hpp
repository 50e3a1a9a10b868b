#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/mini_app_options.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

/// Starts Kokkos with its options. Throws Failure(usage) where it would not start.
std::unique_ptr<device::Runtime> start_kokkos(const std::vector<std::string>& arguments);

/// The backend an option means, present and compiled in. Throws Failure(no_backend).
device::Backend choose_backend(const std::string& wanted);

/// Runs the scene over the product of the axes and writes study.csv, study.json and their picture.
/// Throws Failure: usage for a wrong axis, and what a run of the scene throws.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::gas_app
