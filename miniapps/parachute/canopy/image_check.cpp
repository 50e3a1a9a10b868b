#include <algorithm>

#include "miniapps/parachute/bodies/body_motion.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Key that places a part of the sheets.
const char* place_key(const FlowScene& scene, const SheetParts& parts, std::size_t part) {
  if (part < parts.bodies) return scene.bodies[part].moves() ? "motion" : "centre";
  if (part >= parts.bodies + parts.canopies) return "leading_edge";
  return scene.canopies[part - parts.bodies].payload.shared ? "payload.shared" : "centre";
}

}  // namespace

void check_images(const scene::Place& root, const FlowScene& scene, const Sheets& sheets) {
  const std::vector<Vector> periods = periods_of(scene.parameters);
  if (periods.empty() || !scene.has_sheets()) return;
  const SheetParts parts = parts_of(scene.bodies, sheets);
  const auto lines = whole_lines(sheets, 0.0);
  std::vector<BodyMotion> motions(scene.bodies.begin(), scene.bodies.end());
  constexpr int intervals = 256;
  const bool moves = scene.bodies.size() > 1 && std::ranges::any_of(scene.bodies, &Body::moves);
  for (int i = 0; i <= (moves ? intervals : 0); ++i) {
    const double time = scene.end_time * i / intervals;
    std::vector<Vector> positions = sheets.positions;
    std::size_t vertex = 0;
    for (std::size_t body = 0; body < motions.size(); ++body)
      for (const Vector by = motions[body].at(time); vertex < parts.ends[body]; ++vertex)
        for (std::size_t axis = 0; axis < 3; ++axis) positions[vertex][axis] += by[axis];
    for (const ImageIntersection& found :
         image_intersections(positions, {sheets.fabric.mesh.triangles, lines}, periods, parts)) {
      const std::size_t one = parts.of(found.of_segment), other = parts.of(found.of_triangle),
                        later = std::max(one, other), earlier = std::min(one, other);
      const bool are_bodies = later < parts.bodies,
                 is_canopy = !are_bodies && later < parts.bodies + parts.canopies;
      if (i > 0 && !are_bodies) continue;  // how canopies move is not known
      root.at(parts.name(later))
          .contradict(place_key(scene, parts, later), parts.name(later), is_canopy ? " with its lines" : "",
                      " crosses the image of ", parts.name(earlier), " beyond the periodic sides",
                      are_bodies && moves ? scene::sentence(" at t = ", time, " s") : " at the start",
                      ": the domain must be wider, or have other sides");
    }
  }
}

}  // namespace drogue::parachute_app
