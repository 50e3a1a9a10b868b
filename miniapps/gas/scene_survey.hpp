#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

/// What is seen of the initial state when every cell has been looked at.
struct Survey {
  double p_min = std::numeric_limits<double>::infinity();
  double p_max = 0.0;
  double u_min = std::numeric_limits<double>::infinity();
  double u_max = -std::numeric_limits<double>::infinity();
  std::int64_t first_bad = std::numeric_limits<std::int64_t>::max();  ///< the cell

  [[nodiscard]] bool uniform_flow() const;
  void merge(const Survey& other);
};

/// Looks at the initial state in every cell, with as many threads as there are cores: the largest mesh has
/// 2^28.
Survey survey_initial_state(const GasScene& scene);

/// Why a cell's state is none of a gas: the path of the key to blame and a sentence.
struct BadCell {
  std::string path;
  std::string sentence;
};
BadCell describe_bad_cell(const GasScene& scene, std::int64_t cell);

}  // namespace drogue::gas_app
