#pragma once

#include "common/run/history_reader.hpp"
#include "common/run/result_document.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Area of a body across a direction, a unit vector, m^2: of a file the shadow of its triangles, of others
/// that of their exact shape along an axis. 0 of a plate or disk along its face. Throws only std::bad_alloc.
[[nodiscard]] double frontal_area(const Body& body, const fabric::Vector& direction);

/// Describes the mean drag of body i, 2 F / (rho U^2 A) with its `frontal_area` A, in the group `body_i` of
/// the result as `describe_flights` does that of canopies: of the second half of the run, or of what comes
/// after the start of its wake, if that is less. What has none is left out: bodies that move, a
/// stream that is 0, varies in these means or enters at no side, a face along it. Throws only std::bad_alloc.
void describe_bodies(const FlowScene& scene, const run::History& history, run::ResultDocument& result);

}  // namespace drogue::parachute_app
