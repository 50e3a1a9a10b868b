#include "miniapps/parachute/verify/body_drag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/run/history_statistics.hpp"
#include "common/run/uncertainty.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using scene::element, scene::rough_text, scene::sentence;
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

/// Least ratio of a run to the start of a wake that leaves time for a mean behind it.
constexpr double rest_of_start = 1.2;

/// A body at rest in a stream that becomes steady.
struct BodyInStream {
  std::size_t index;
  Vector direction;  ///< of the stream
  std::size_t axis;  ///< most along it
  double speed;      ///< m/s
  double area;       ///< m^2
  double width;      ///< m, least one across the stream
  double blockage;   ///< part of the section of the domain that it covers
  double start;      ///< widths of stream that pass while its wake starts up
  double passed;     ///< widths of stream that pass in the run

  /// True for a sheet across a channel, which has no wake.
  [[nodiscard]] bool closes() const { return blockage > 0.999; }
};

/// Time, s, at which so many widths of the stream have passed.
double time_of(const FlowScene& scene, const BodyInStream& body, double widths) {
  return scene.end_time + (widths - body.passed) * body.width / body.speed;
}

/// Begin of the mean of a drag, s.
double begin_of_mean(const FlowScene& scene, const BodyInStream& body) {
  const double half = 0.5 * scene.end_time;
  if (body.closes() || body.passed < rest_of_start * body.start) return half;
  return std::max(half, time_of(scene, body, body.start));
}

/// Length of the stream that passes in the run, m.
double length_of_stream(const FlowScene& scene) {
  constexpr int times = 256;
  const SpaceTimeVector velocity(scene.velocity);
  const Vector middle = middle_of(scene.parameters);
  double sum = 0.0;
  for (int k = 0; k <= times; ++k) {
    const double weight = k == 0 || k == times ? 0.5 : 1.0;
    sum += weight * length_of(velocity(middle, scene.end_time * k / times));
  }
  return sum * scene.end_time / times;
}

std::vector<BodyInStream> bodies_in_stream(const FlowScene& scene) {
  if (scene.bodies.empty()) return {};
  const std::optional<Vector> stream = stream_from(scene, 0.5 * scene.end_time);
  if (!stream) return {};
  const flow::Parameters& p = scene.parameters;
  Vector direction = *stream;
  const double speed = length_of(direction), length = length_of_stream(scene);
  std::size_t axis = 0;
  double section = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    direction[k] /= speed;
    if (std::abs(direction[k]) > std::abs(direction[axis])) axis = k;
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (k != axis) section *= length_of(p, k);
  std::vector<BodyInStream> found;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const double area = frontal_area(body, direction);
    if (body.moves() || body.mount || !(area > 0.0)) continue;
    double width = run::never;
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis && p.cells[k] > 1) width = std::min(width, body.extents()[k][0] + body.extents()[k][1]);
    // Wakes of spheres are steady up to a Reynolds number of 280, and take 12 diameters for it; those of
    // disks and cups at 1000 take 40 (docs/coupling-notebook.md, drag of bodies).
    const double start = p.density * speed * width <= 280.0 * p.viscosity ? 12.0 : 40.0;
    found.push_back({i, direction, axis, speed, area, width, area / section, start, length / width});
  }
  return found;
}

/// At least `value`, of three digits.
double rounded_up(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return std::ceil(value / digit) * digit;
}

/// Notes a section of which bodies cover so much that they have the drag of a duct.
void note_blockage(FlowScene& scene, const std::vector<BodyInStream>& bodies) {
  const flow::Parameters& p = scene.parameters;
  const std::size_t axis = bodies.front().axis;
  double area = 0.0, blockage = 0.0, depth = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    if (k != axis && p.cells[k] == 1) depth = length_of(p, k);
  for (const BodyInStream& body : bodies) area += body.area, blockage += body.blockage;
  if (blockage <= most_blockage) return;
  const double needed = area / most_blockage;
  scene.note("grid.domain: ", bodies.size() > 1 ? "bodies cover up to " : "the body covers ",
             rough_text(100.0 * blockage), " % of its section across ", axis_names[axis],
             bodies.size() > 1 ? ", so that their" : ", so that its",
             " drag is that in a duct and not in free air; ",
             depth > 0.0
                 ? sentence("sides ", rough_text(rounded_up(needed / depth)), " m apart have")
                 : sentence("a square section of ", rough_text(rounded_up(std::sqrt(needed))), " m has"),
             " at most ", rough_text(100.0 * most_blockage), " %");
}

}  // namespace

void note_unfit_bodies(FlowScene& scene) {
  const std::vector<BodyInStream> bodies = bodies_in_stream(scene);
  if (bodies.empty() || std::ranges::any_of(bodies, &BodyInStream::closes)) return;
  note_blockage(scene, bodies);
  for (const BodyInStream& body : bodies) {
    const double needed = rest_of_start * body.start;
    if (body.passed >= needed) continue;
    scene.note("run.end_time: ", rough_text(body.passed), " widths of ", element("body", body.index),
               " pass with the stream, and its wake starts up in some ", rough_text(body.start),
               ", so that its drag is not yet that of a steady stream; ",
               rough_text(rounded_up(time_of(scene, body, needed))), " s leave time for a mean");
  }
}

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
  if (history.empty()) return;
  const std::vector<double>& time = history.at("time");
  for (const BodyInStream& body : bodies_in_stream(scene)) {
    const double from = begin_of_mean(scene, body), area = body.area, speed = body.speed;
    const Vector& direction = body.direction;
    const std::string group = "body_" + std::to_string(body.index);
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
