#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/scene/codec.hpp"
#include "miniapps/parachute/scene/scene.hpp"

/// Codecs of the values that these scenes alone have. None throws.
namespace drogue::parachute_app {

/// Array of three intervals, one per axis, or nothing.
scene::Codec box_codec(Box& box);
scene::Codec box_codec(std::optional<Box>& box);

/// One real for all axes, or an array of three.
scene::Codec spacing_codec(std::array<double, 3>& spacing);

/// Array of three lists of reals or names of files, or nothing.
scene::Codec faces_codec(std::optional<std::array<AxisFaces, 3>>& faces);

/// Array of three reals or expressions of `variables`.
scene::Codec vector_expression_codec(VectorExpression& vector, const std::vector<std::string>& variables);

/// Array of pairs of reals whose first numbers increase.
scene::Codec points_codec(std::vector<std::array<double, 2>>& points);

/// Type of both sides of an axis, or an array of two types.
scene::Codec sides_codec(std::optional<SidePair>& sides);

/// A time step, s, or "auto", which stands for 0.
scene::Codec time_step_codec(double& dt);

/// Real that prints as `standard()` where it is 0, which stands for that.
scene::Codec standard_if_zero(double& value, const std::function<double()>& standard);

}  // namespace drogue::parachute_app
