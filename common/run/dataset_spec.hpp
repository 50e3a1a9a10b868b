#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drogue::run {

/// A dataset as readers see it.
struct DatasetSpec {
  std::string name;
  std::vector<std::uint64_t> shape;
  std::string units;      ///< `kg/m^3`; `1` for a pure number
  std::string centering;  ///< cell | vertex | face | edge
  std::string description;
};

/// Number of entries.
[[nodiscard]] inline std::uint64_t entries(const DatasetSpec& spec) {
  std::uint64_t product = 1;
  for (const std::uint64_t n : spec.shape) product *= n;
  return product;
}

}  // namespace drogue::run
