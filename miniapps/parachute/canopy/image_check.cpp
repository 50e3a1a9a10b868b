#include "miniapps/parachute/canopy/image_check.hpp"

#include <algorithm>
#include <string>

#include "common/scene/read.hpp"
#include "miniapps/parachute/bodies/body_motion.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using scene::contradict;
using scene::real_text;
using scene::Table;

/// Key that places a part of the sheets, below its name.
std::string place_key(const FlowScene& scene, const SheetParts& parts, std::size_t part) {
  if (part < parts.bodies) return scene.bodies[part].moves() ? ".motion" : ".centre";
  if (part >= parts.bodies + parts.canopies) return ".leading_edge";
  return scene.canopies[part - parts.bodies].payload.shared ? ".payload.shared" : ".centre";
}

/// `when`: the time, after a space.
void refuse(const Table& root, const FlowScene& scene, const SheetParts& parts,
            const ImageIntersection& found, const std::string& when) {
  const std::size_t one = parts.of(found.of_segment), other = parts.of(found.of_triangle),
                    later = std::max(one, other), earlier = std::min(one, other);
  const bool is_canopy = later >= parts.bodies && later < parts.bodies + parts.canopies;
  contradict(root, parts.name(later) + place_key(scene, parts, later),
             parts.name(later) + (is_canopy ? " with its lines" : "") + " crosses the image of " +
                 parts.name(earlier) + " beyond the periodic sides" + when +
                 ": the domain must be wider, or have other sides");
}

}  // namespace

void check_images(const Table& root, const FlowScene& scene) {
  const std::vector<Vector> periods = periods_of(scene.parameters);
  if (periods.empty() || !scene.has_sheets()) return;
  const Sheets sheets = make_all_sheets(scene.bodies, scene.canopies, scene.parameters.density,
                                        scene.parameters.viscosity, scene.flags);
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
      const bool are_bodies =
          std::max(parts.of(found.of_segment), parts.of(found.of_triangle)) < parts.bodies;
      // How canopies move is not known.
      if (i == 0 || are_bodies)
        refuse(root, scene, parts, found,
               are_bodies && moves ? " at t = " + real_text(time) + " s" : " at the start");
    }
  }
}

}  // namespace drogue::parachute_app
