#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace drogue::run {

/// Size of the user block of a restart file, bytes: format, file length, checksum of the rest, scene. HDF5 is
/// not robust against damaged files, so it opens a file only after its seal was verified.
constexpr std::uint64_t seal_bytes = 512;

/// Writes the seal of a closed file. Throws `Failure` (io_error).
void write_seal(const std::filesystem::path& file, const std::string& scene);

/// Throws `Failure` (io_error), with the fault, unless `file` is whole and belongs to `scene`.
void check_seal(const std::filesystem::path& file, const std::string& scene);

}  // namespace drogue::run
