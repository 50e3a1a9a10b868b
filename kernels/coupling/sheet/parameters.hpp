#pragma once

#include <cstdint>
#include <vector>

#include "kernels/coupling/sheet/sheet_parameters.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::coupling {

/// Courant number of the flow unless `flow::Parameters::cfl` is given.
inline constexpr double default_cfl = 0.5;

/// Largest number of steps of the cloth in a step of the flow that follows from the frequency of the cloth.
/// Steps of parachutes hold some hundred; a step of the flow is the shortest work that can be interrupted.
inline constexpr std::int64_t most_substeps = 4096;

/// Parameters of cloth in air.
struct Parameters {
  /// `external_force` is set by the coupling. With `fixed_dt` = 0, dt follows from `cfl`, by
  /// default 0.5, and is constant in blocks of steps; `max_dt` must then be positive, since air at rest does
  /// not limit dt.
  flow::Parameters flow;
  fabric::Parameters fabric;  ///< integrator, dt and interval of contact are set by the coupling
  SheetParameters sheet;
  FollowParameters follow;
  /// Steps of the cloth in each step of the flow; 0: as many as keep the product of their dt and the largest
  /// angular frequency of the cloth below 1 at the beginning of each block. More than `most_substeps` are a
  /// failure.
  int substeps = 0;
  /// Steps of the cloth between resolutions of contact, >= 1 (`fabric::Contact::interval`). Each step of the
  /// flow ends with one.
  int contact_interval = 32;
  /// Time of the steps that are enqueued at once, s, > 0, beyond which the next ones are fewer: requests to
  /// stop are answered between them. It changes no result.
  double longest_batch = 0.4;
  std::vector<LineDrag> line_drag;      ///< not with `CouplingMethod::sharp`
  std::vector<VertexDrag> vertex_drag;  ///< likewise
  std::vector<LineCut> cuts;            ///< a block of steps ends at the time of each
  /// Tension of each line at the end of a step beyond which the step fails, N; infinite for lines without
  /// limit; or empty.
  std::vector<double> line_strength;
};

}  // namespace drogue::coupling
