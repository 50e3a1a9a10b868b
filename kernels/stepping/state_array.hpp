#pragma once

#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace drogue::stepping {

/// Array of the state of a solver, in double precision. From all its arrays and its progress, an equal solver
/// continues bit for bit.
struct StateArray {
  std::string name;                 ///< in restart files, such as "velocity_x"
  std::string unit;                 ///< such as "m/s"
  std::vector<std::size_t> extent;  ///< index that varies fastest last
  /// Of an array that several ranks share: extent of the whole array, and first indices of this part. Empty
  /// for one that each rank holds.
  std::vector<std::size_t> whole = {}, begin = {};

  /// Number of entries. Does not throw.
  [[nodiscard]] std::size_t size() const {
    return std::accumulate(extent.begin(), extent.end(), std::size_t{1}, std::multiplies<>());
  }
};

}  // namespace drogue::stepping
