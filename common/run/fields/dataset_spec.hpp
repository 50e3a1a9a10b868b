#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drogue::run {

/// Description of an HDF5 dataset.
struct DatasetSpec {
  std::string name;
  std::vector<std::uint64_t> shape;  ///< row-major
  std::string units;                 ///< `kg/m^3`; `1` for a pure number
  std::string centering;             ///< cell | vertex | face | edge
  std::string description;
  std::string grid = {};  ///< name of the grid in a file with several; empty: the main grid
};

/// Path below `/mesh` or `/steps/N`: the name of the dataset, after that of its grid if it has one. Does not
/// throw.
[[nodiscard]] inline std::string path_of(const DatasetSpec& spec) {
  return spec.grid.empty() ? spec.name : spec.grid + "/" + spec.name;
}

/// Number of entries. Does not throw.
[[nodiscard]] inline std::uint64_t entries(const DatasetSpec& spec) {
  std::uint64_t product = 1;
  for (const std::uint64_t n : spec.shape) product *= n;
  return product;
}

}  // namespace drogue::run
