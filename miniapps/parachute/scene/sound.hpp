#pragma once

#include <optional>
#include <string>

#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Clause on a speed, m/s, at which a fluid is compressible, Mach 0.3 and more; none at lower speeds, and for
/// a fluid whose speed of sound is not known: one with neither the density nor the viscosity of air or water.
/// Throws only std::bad_alloc.
[[nodiscard]] std::optional<std::string> compressibility_text(const flow::Parameters& p, double speed);

/// Notes a stream, or the start of a canopy, at such a speed.
void note_compressibility(FlowScene& scene);

}  // namespace drogue::parachute_app
