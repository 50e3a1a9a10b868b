#pragma once

#include <cmath>
#include <string>

#include "common/run/result_document.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Adds a check of the relative deviation of a value from a target, both in any one unit. Throws only
/// std::bad_alloc.
inline void check_target(run::ResultDocument& result, const std::string& name, double value,
                         const Target& target) {
  const double margin = std::abs(target.value) * target.tolerance;
  result.add_check(name, std::abs(value / target.value - 1.0), target.tolerance,
                   run::Measurement{value, target.value - margin, target.value + margin});
}

/// Adds a check of the distance between a value and a target; these and the tolerance have any one unit.
/// Throws only std::bad_alloc.
inline void check_distance(run::ResultDocument& result, const std::string& name, double value, double target,
                           double tolerance) {
  result.add_check(name, std::abs(value - target), tolerance,
                   run::Measurement{value, target - tolerance, target + tolerance});
}

}  // namespace drogue::parachute_app
