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

/// One scheme of a study; `power` counts for Z alone.
struct StudyScheme {
  std::string name;  ///< as on the command line: js, z, z2, m, teno5
  gas::Weno weno = gas::Weno::z;
  int power = 1;
};

/// What `--study` asks to vary; an empty list keeps the scene's own value.
struct StudyAxes {
  std::vector<std::int64_t> meshes;
  std::vector<StudyScheme> schemes;
  std::vector<std::string> splittings, times, precisions;
};

/// Reads `meshes=100:800,schemes=js:z,splittings=...,times=...,precisions=...`. Two meshes are the ends of a
/// doubling sequence; three or more are taken as they stand. Throws Failure(usage).
StudyAxes parse_study(const std::string& text);

/// Runs the scene over the product of the axes and writes study.csv, study.json and the pictures of both.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::gas_app
