#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/run/restart/restart_file.hpp"

namespace drogue::run {

/// Size of the user block of a restart file, bytes: format, file length, checksum of the rest, scene. HDF5 is
/// not robust against damaged files, so it opens a file only after its seal was verified.
constexpr std::uint64_t seal_bytes = 512;

/// Writes the seal of a closed file. Throws `Failure` (io_error).
void write_seal(const std::filesystem::path& file, const std::string& scene);

/// Throws `Failure` (io_error), with the fault, unless `file` is whole and belongs to `scene`. If it belongs
/// to another one, `describe_difference`, which may be empty, adds to the fault.
void check_seal(const std::filesystem::path& file, const std::string& scene,
                const DescribeDifference& describe_difference);

}  // namespace drogue::run
