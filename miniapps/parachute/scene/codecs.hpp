#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/scene/codec.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Array of three intervals, one per axis. Does not throw.
scene::Codec domain_codec(std::array<double, 3>& low, std::array<double, 3>& high);

/// Array of three intervals, or nothing. Does not throw.
scene::Codec core_codec(std::optional<GridCore>& core);

/// One real for all axes, or an array of three. Does not throw.
scene::Codec spacing_codec(std::array<double, 3>& spacing);

/// Array of three lists of reals or names of files, or nothing. Does not throw.
scene::Codec faces_codec(std::optional<std::array<AxisFaces, 3>>& faces);

/// Array of three reals or expressions of `variables`. Does not throw.
scene::Codec vector_expression_codec(VectorExpression& vector, const std::vector<std::string>& variables);

/// Array of pairs of reals whose first numbers increase. Does not throw.
scene::Codec points_codec(std::vector<std::array<double, 2>>& points);

/// Type of both sides of an axis, or an array of two types. Does not throw.
scene::Codec sides_codec(std::optional<SidePair>& sides);

/// A time step, s, or "auto", which stands for 0. Does not throw.
scene::Codec time_step_codec(double& dt);

/// Real that prints as `standard()` where it is 0, which stands for that. Does not throw.
scene::Codec standard_if_zero(double& value, const std::function<double()>& standard);

}  // namespace drogue::parachute_app
