#pragma once

#include <span>

#include "kernels/fabric/state.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// What a scene asks a solver to do. Its vertices are numbered so that neighbours lie close together; `order`
/// names the vertex of the scene's mesh that each of them is.
struct Problem {
  std::vector<int> order;
  fabric::Parameters parameters;
  std::vector<fabric::Vector> x, v;  ///< at the start, in the scene's numbering
  std::vector<int> probes;           ///< their vertices, in the solver's numbering
  double mass = 0.0, payload = 0.0;  ///< of all; part of it, kg

  /// From the scene's numbering to the solver's, and back.
  [[nodiscard]] std::vector<fabric::Vector> to_solver(std::span<const fabric::Vector> values) const;
  [[nodiscard]] std::vector<fabric::Vector> to_scene(std::span<const fabric::Vector> values) const;
  [[nodiscard]] std::vector<fabric::ContactWork> to_solver(std::span<const fabric::ContactWork> values) const;
  [[nodiscard]] std::vector<fabric::ContactWork> to_scene(std::span<const fabric::ContactWork> values) const;
  [[nodiscard]] std::vector<fabric::Stress> to_scene(std::span<const fabric::Stress> values) const;
};

Problem make_problem(const SpringsScene& scene);

}  // namespace drogue::springs_app
