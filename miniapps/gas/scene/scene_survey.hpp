#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Extrema of the initial state over cells.
struct Survey {
  double p_min = std::numeric_limits<double>::infinity();
  double p_max = 0.0;
  double u_min = std::numeric_limits<double>::infinity();
  double u_max = -std::numeric_limits<double>::infinity();
  double speed_max = 0.0;                                             ///< of |u| + c, m/s
  std::int64_t first_bad = std::numeric_limits<std::int64_t>::max();  ///< first invalid cell

  [[nodiscard]] bool uniform_flow() const;
  void merge(const Survey& other);
};

/// Surveys the initial state of cells with one thread per core.
Survey survey_initial_state(const GasScene& scene, framework::InitialCheck check);

/// Invalid initial state: the path of the key in error and a sentence.
struct BadCell {
  std::string path;
  std::string sentence;
};
BadCell describe_bad_cell(const GasScene& scene, std::int64_t cell);

}  // namespace drogue::gas_app
