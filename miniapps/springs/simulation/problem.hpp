#pragma once

#include <span>

#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/results.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Parameters and initial state of the solver for a scene. The solver numbers vertices so that neighbours are
/// close in memory; `order` maps its vertices to those of the scene.
struct Problem {
  std::vector<int> order;
  fabric::Parameters parameters;
  std::vector<fabric::Vector> x, v;  ///< initial state, in the scene's numbering
  std::vector<int> probes;           ///< their vertices, in the solver's numbering
  double mass = 0.0, payload = 0.0;  ///< total, and part of it, kg

  /// Permutes from the scene's numbering to the solver's, and back.
  [[nodiscard]] std::vector<fabric::Vector> to_solver(std::span<const fabric::Vector> values) const;
  [[nodiscard]] std::vector<fabric::Vector> to_scene(std::span<const fabric::Vector> values) const;
  /// Rows of any equal number of values.
  [[nodiscard]] std::vector<double> to_solver(std::span<const double> values) const;
  [[nodiscard]] std::vector<double> to_scene(std::span<const double> values) const;
  [[nodiscard]] std::vector<fabric::Stress> to_scene(std::span<const fabric::Stress> values) const;
};

Problem make_problem(const SpringsScene& scene);

}  // namespace drogue::springs_app
