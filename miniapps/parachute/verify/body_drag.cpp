#include "miniapps/parachute/verify/body_drag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/run/history_statistics.hpp"
#include "common/run/uncertainty.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using std::numbers::pi;

/// Area of the shadow of the triangles of a body along a direction, m^2.
double shadow(Body body, const Vector& direction) {
  body.retraction = 0.0;
  // Two axes across the direction; the third one is it.
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (std::abs(direction[axis]) < std::abs(direction[least])) least = axis;
  Vector first{}, second{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    first[axis] = (axis == least ? 1.0 : 0.0) - direction[least] * direction[axis];
  const double length = std::hypot(first[0], first[1], first[2]);
  for (double& component : first) component /= length;
  for (std::size_t k = 0; k < 3; ++k)
    second[k] = direction[(k + 1) % 3] * first[(k + 2) % 3] - direction[(k + 2) % 3] * first[(k + 1) % 3];
  mesh::Mesh mesh = mesh_of(body);
  for (Vector& x : mesh.rest) {
    Vector turned{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double offset = x[k] - body.centre[k];
      turned[0] += first[k] * offset, turned[1] += second[k] * offset;
    }
    x = turned;
  }
  return projected_area(mesh.rest, mesh.triangles);
}

/// Velocity of the stream from a time on, m/s; none where it still varies by a thousandth, in time or place,
/// and without an inflow: then the velocity of the start decays.
std::optional<Vector> stream_from(const FlowScene& scene, double from) {
  if (std::ranges::none_of(scene.parameters.boundary, [](const flow::Boundary& side) {
        return side.kind == flow::BoundaryKind::inflow;
      }))
    return {};
  constexpr double largest_change = 1e-3;
  constexpr int times = 16;
  const flow::Parameters& p = scene.parameters;
  const SpaceTimeVector velocity(scene.velocity);
  const auto velocity_at = [&](double part, double time) {
    Vector place{};
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = std::lerp(p.low[axis], p.high[axis], part);
    return velocity(place, time);
  };
  const Vector last = velocity_at(0.5, scene.end_time);
  const double bound = largest_change * std::hypot(last[0], last[1], last[2]);
  for (int k = 0; k <= times; ++k)
    for (const double part : {0.03, 0.29, 0.5, 0.83}) {
      const Vector v = velocity_at(part, std::lerp(from, scene.end_time, static_cast<double>(k) / times));
      if (!(std::hypot(v[0] - last[0], v[1] - last[1], v[2] - last[2]) < bound)) return {};
    }
  return last;
}

}  // namespace

double frontal_area(const Body& body, const Vector& direction) {
  const double circle = pi * body.radius * body.radius,
               along = std::abs(direction[static_cast<std::size_t>(body.axis)]);
  const bool is_along = along > 1.0 - 1e-9, is_across = along < 1e-9;
  switch (body.kind) {
    case BodyKind::sphere:
      return circle;
    case BodyKind::plate:
      return along * (body.lengths[0] * body.lengths[1] - pi * body.hole * body.hole);
    case BodyKind::disk:
      return along * circle;
    case BodyKind::cylinder:
      if (is_across) return 2.0 * body.radius * body.length;
      if (is_along && body.has_ends) return circle;
      break;
    case BodyKind::cup:
      if (is_along) return circle;
      if (is_across) return 0.5 * circle;
      break;
    case BodyKind::file:
      break;
  }
  return shadow(body, direction);
}

void describe_bodies(const FlowScene& scene, const run::History& history, run::ResultDocument& result) {
  const double from = 0.5 * scene.end_time;
  if (history.empty() || scene.bodies.empty()) return;
  const std::optional<Vector> stream = stream_from(scene, from);
  if (!stream) return;
  Vector direction = *stream;
  const double speed = std::hypot(direction[0], direction[1], direction[2]);
  for (double& component : direction) component /= speed;
  const std::vector<double>& time = history.at("time");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const double area = frontal_area(body, direction);
    if (body.moves() || body.mount || !(area > 0.0)) continue;
    const std::string group = "body_" + std::to_string(i);
    std::vector<double> drag(time.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double>& force = history.at(group + "_force_" + axis_names[axis]);
      for (std::size_t row = 0; row < drag.size(); ++row)
        drag[row] += direction[axis] * force[row] / (0.5 * scene.parameters.density * speed * speed * area);
    }
    const auto mean = [&](double begin, double end) { return run::mean_between({time, drag}, begin, end); };
    const double value = mean(from, scene.end_time),
                 error = run::batch_half_width(mean, from, scene.end_time);
    if (!std::isfinite(value)) continue;
    result.metrics.set(group, "from", from);
    result.metrics.set(group, "frontal_area", area);
    result.metrics.set(group, "drag_coefficient", value);
    if (std::isfinite(error)) result.metrics.set(group, "drag_coefficient_error", error);
  }
}

}  // namespace drogue::parachute_app
