#pragma once

#include <string>

#include "kernels/coupling/sheet/parameters.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Weight of the present step in the running mean of the acceleration of the fluid, unless the law of a
/// canopy allows another one.
inline constexpr double standard_filter = coupling::SheetParameters().filter;

/// Courant number of the longest steps in the stream of a scene, at most that of the run. Does not throw.
[[nodiscard]] double courant_number(const FlowScene& scene);

/// Inset of free edges, cells, by the Courant number. Does not throw.
[[nodiscard]] double standard_edge_inset(const FlowScene& scene);

/// Inset of free edges, cells, and weight of the smoothed defect in its mean: of the scene, or by default. Do
/// not throw.
[[nodiscard]] double edge_inset(const FlowScene& scene);
[[nodiscard]] double leak_filter(const FlowScene& scene);

/// Weight of the present step in the mean of the acceleration of the fluid, or that each canopy takes that of
/// its law. Throws only std::bad_alloc.
[[nodiscard]] std::string filter_text(const FlowScene& scene);

/// Parameters of the exchange of sheets with the fluid: those of the scene, and of its corrections where it
/// has none. Throws only std::bad_alloc.
[[nodiscard]] coupling::SheetParameters exchange_parameters(const FlowScene& scene, const Sheets& sheets);

}  // namespace drogue::parachute_app
