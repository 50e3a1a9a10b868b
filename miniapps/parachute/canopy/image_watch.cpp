#include "miniapps/parachute/canopy/image_watch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Steps of a block of the coupled solver, after which the host waits in any case.
constexpr double most_steps = 16.0;

/// Steps in which sheets cannot cross a distance, m. Both may move, and their speeds may double.
std::int64_t steps_apart(double distance, const SheetMotion& now) {
  double squared = 0.0;
  for (const Vector& v : now.velocities) squared = std::max(squared, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double stride = now.dt * std::sqrt(squared);
  const double steps = stride > 0.0 ? distance / (4.0 * stride) : 1.0;
  return static_cast<std::int64_t>(std::clamp(steps, 1.0, most_steps));
}

}  // namespace

ImageWatch::ImageWatch(const FlowScene& scene, const Sheets& sheets)
    : _sheets(sheets), _parts(parts_of(scene.bodies, sheets)), _periods(periods_of(scene.parameters)) {
  if (_periods.empty() || std::ranges::none_of(_parts.moves, std::identity{})) _next = never;
}

std::optional<std::string> ImageWatch::look(const SheetMotion& now) {
  const auto lines = whole_lines(_sheets, now.time);
  const double distance = distance_from_images(now.positions, lines, _periods, _parts);
  _next = std::isinf(distance) ? never : now.step + steps_apart(distance, now);
  if (distance > 0.0) return std::nullopt;
  const auto found =
      image_intersections(now.positions, {_sheets.fabric.mesh.triangles, lines}, _periods, _parts);
  if (found.empty()) return std::nullopt;
  const auto [segment, triangle] = found.front();
  return _parts.name(_parts.of(segment)) + " meets the image of " + _parts.name(_parts.of(triangle)) +
         " beyond the periodic sides at " + place_text(now.positions[static_cast<std::size_t>(segment)]) +
         " m";
}

}  // namespace drogue::parachute_app
