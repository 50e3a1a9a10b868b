#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace drogue::run {

/// Bytes at the begin of a restart file that HDF5 leaves to us (its user block): format, length of the file,
/// checksum of all that follows, scene. HDF5 is not made for damaged files; it sees one only after the seal
/// was found whole.
constexpr std::uint64_t seal_bytes = 512;

/// Seals a closed file. Throws Failure(io_error).
void write_seal(const std::filesystem::path& file, const std::string& scene);

/// Throws Failure(io_error), saying what is wrong, unless `file` is whole and of `scene`.
void check_seal(const std::filesystem::path& file, const std::string& scene);

}  // namespace drogue::run
