#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/scene/codec.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Names of the axes in scenes.
inline const scene::Choices<int> axis_choices = {{"x", 0}, {"y", 1}, {"z", 2}};

/// Array of three integers within the declared limits. Does not throw.
scene::Codec cells_codec(std::array<int, 3>& cells);

/// Array of three intervals, one per axis. Does not throw.
scene::Codec domain_codec(std::array<double, 3>& low, std::array<double, 3>& high);

/// Array of three reals. Does not throw.
scene::Codec vector_codec(std::array<double, 3>& vector);

/// Array of two reals. Does not throw.
scene::Codec pair_codec(std::array<double, 2>& pair);

/// Array of two reals, absent if not set. Does not throw.
scene::Codec optional_pair_codec(std::optional<std::array<double, 2>>& pair);

/// Array of three reals or expressions of `variables`. Does not throw.
scene::Codec vector_expression_codec(VectorExpression& vector, std::vector<std::string> variables);

/// Array of pairs of reals whose first numbers increase. Does not throw.
scene::Codec points_codec(std::vector<std::array<double, 2>>& points);

/// Type of both sides of an axis, or an array of two types. Does not throw.
scene::Codec sides_codec(std::optional<SidePair>& sides);

/// Integer, absent if not set. Does not throw.
scene::Codec optional_integer_codec(std::optional<int>& value);

/// A time step, s, or "auto", which stands for 0. Does not throw.
scene::Codec time_step_codec(double& dt);

/// Treats the value 0 as absent. Does not throw.
scene::Codec absent_if_zero(scene::Codec codec, const double& value);

/// Prints `standard()` for the value 0, which stands for it. Does not throw.
scene::Codec standard_if_zero(scene::Codec codec, const double& value, std::function<double()> standard);

}  // namespace drogue::parachute_app
