#pragma once

#include <optional>

#include "common/run/history_reader.hpp"
#include "common/run/result_document.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Final state of a run, in the numbering of the scene.
struct FinalState {
  std::vector<fabric::Vector> x;      ///< m
  std::vector<fabric::Vector> force;  ///< on every vertex, with gravity, without damping, N
  std::vector<std::uint8_t> pinned;   ///< 1 for x, 2 for y, 4 for z
  double largest_load = 0.0;          ///< largest dead load on a vertex without gravity, N
  double mass = 0.0;                  ///< total, kg
  double payload = 0.0;               ///< part of the mass, kg
  double elastic_energy = 0.0;        ///< J
  std::vector<double> von_mises;      ///< of every vertex, N/m; empty unless the scene verifies one
};

/// True if a check follows the run in its history.csv.
[[nodiscard]] bool needs_history(const Verify& wanted);

/// Adds errors and checks of the scene's [verify]; `history` is the history.csv of the run, or empty if no
/// check `needs_history`.
void verify(const SpringsScene& scene, const FinalState& state, const run::History& history,
            run::ResultDocument& result);

/// Energy that steps in time lost in a scene that `conserves_energy`.
struct EnergyLoss {
  double energy =
      0.0;             ///< J, between the first row of the history and the last, without contact and friction
  double share = 0.0;  ///< of the largest kinetic energy of a row or of all released energy
};

/// Nothing if nothing moved.
[[nodiscard]] std::optional<EnergyLoss> energy_loss(const run::History& history);

/// Young's modulus (N/m) and Poisson's ratio of a rectangle pulled along x by its last column.
struct Response {
  double young = 0.0, poisson = 0.0, strain = 0.0;
  double width = 0.0;  ///< m, at rest
};
Response pulled_response(const fabric::Mesh& mesh, const FinalState& state);

/// Force over strain, N, that all lines add to a mesh pulled along x, provided that uniform strain leaves
/// them in equilibrium: lines along x with equal stiffness on both sides of every inner vertex. Requires
/// line_stiffness.
std::optional<double> even_line_stiffness(const fabric::Mesh& mesh);

/// Largest force on a free axis over the largest on a prescribed axis or dead load.
double imbalance(const FinalState& state);

}  // namespace drogue::springs_app
