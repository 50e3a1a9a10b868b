#pragma once

#include <filesystem>
#include <optional>

#include "common/run/result_document.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// Where a run has come to, in the numbering of the scene's mesh.
struct FinalState {
  std::vector<fabric::Vector> x;      ///< m
  std::vector<fabric::Vector> force;  ///< on every vertex, gravity included, damping not, N
  std::vector<std::uint8_t> pinned;   ///< 1 for x, 2 for y, 4 for z
  double largest_load = 0.0;          ///< dead, on a vertex, gravity excluded, N
  double mass = 0.0;                  ///< of all, kg
  double payload = 0.0;               ///< part of it, kg
};

/// Errors and checks as the scene's [verify] asks; `history` is the history.csv of the run.
void verify(const SpringsScene& scene, const FinalState& state, const std::filesystem::path& history,
            run::ResultDocument& result);

/// Young's modulus (N/m) and Poisson's ratio of a rectangle pulled along x by its last column.
struct Response {
  double young = 0.0, poisson = 0.0, strain = 0.0;
  double width = 0.0;  ///< m, at rest
};
Response pulled_response(const fabric::Mesh& mesh, const FinalState& state);

/// What all lines together add to the force over strain of a mesh pulled along x, N, if an even strain leaves
/// them balanced: they run along x, and of every vertex within to both sides with the same stiffness. The
/// mesh must have its line_stiffness.
std::optional<double> even_line_stiffness(const fabric::Mesh& mesh);

/// Largest force on a free axis over the largest on a held one or dead load.
double imbalance(const FinalState& state);

}  // namespace drogue::springs_app
