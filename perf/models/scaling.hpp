#pragma once

#include <array>
#include <string>
#include <vector>

namespace drogue::perf {

/// 1, 2, 4, ... and `most` units of a machine: threads, ranks or GPUs; 1 for less. Does not throw.
[[nodiscard]] std::vector<int> unit_counts(int most);

/// Share of ideal scaling: `of_one`, s, over the time of `units` units, of the same work in strong scaling,
/// of as many times the work in weak scaling. Does not throw.
[[nodiscard]] double efficiency(bool weak, double of_one, double time, int units);

/// Cells of a flow on several units: `one`, or as many of them along z in weak scaling. Does not throw.
[[nodiscard]] std::array<int, 3> scaled_cells(const std::array<int, 3>& one, bool weak, int units);

/// Scene of drogue-parachute: steps of drifting Taylor-Green vortices in a periodic box of cubes as cells, 2
/// pi m along x and y, which checks the exact solution and the divergence. Does not throw.
[[nodiscard]] std::string flow_scene(const std::array<int, 3>& cells, int steps);

}  // namespace drogue::perf
