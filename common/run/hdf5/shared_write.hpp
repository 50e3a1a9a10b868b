#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

namespace drogue::run {

/// Part of a row-major array: extent of the whole, and begin and extent of the part along each dimension.
struct ArrayPart {
  std::vector<std::uint64_t> whole, begin, extent;

  [[nodiscard]] std::size_t entries() const {
    return std::accumulate(extent.begin(), extent.end(), std::size_t{1}, std::multiplies<>());
  }
};

/// Writes the parts that all ranks hold of one array of doubles to an existing file, from byte `offset` on,
/// by MPI-IO. Collective on all processes of the program; blocks until the system has the data. Throws
/// `Failure` (io_error) on all ranks if one fails.
void write_parts(const std::filesystem::path& file, std::uint64_t offset, const ArrayPart& part,
                 std::span<const double> values);

}  // namespace drogue::run
