#include <algorithm>

#include "kernels/reference/fabric/intersections.hpp"
#include "miniapps/parachute/bodies/body_motion.hpp"
#include "miniapps/parachute/bodies/box.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using mesh::Vector;

/// Part of the edges by which a body is displaced: surfaces that only touch then part.
constexpr double displacement = 1e-3;

/// Surface of a body at a time.
struct Surface {
  std::vector<Vector> positions;
  std::vector<std::array<int, 3>> triangles;
  Box box;

  [[nodiscard]] Surface moved(const Vector& by) const {
    Surface surface = *this;
    for (Vector& x : surface.positions) x = displaced(x, by);
    surface.box = displaced(box, by);
    return surface;
  }

  /// Appends the triangles that reach into a box to the parts of a pair.
  void append(const Box& region, std::vector<Vector>& points, std::vector<std::array<int, 3>>& faces) const {
    const int first = static_cast<int>(points.size());
    points.insert(points.end(), positions.begin(), positions.end());
    for (const auto& corners : triangles) append_within(region, corners, positions, first, faces);
  }
};

/// True if two surfaces have a common point, with the second one displaced by `by`, m.
bool meet(const Surface& a, const Surface& b, const Vector& by) {
  const Surface moved = b.moved(by);
  if (distance(a.box, moved.box) > 0.0) return false;
  const Box region = common(a.box, moved.box);
  std::vector<Vector> points;
  std::vector<std::array<int, 3>> faces;
  a.append(region, points, faces);
  const std::size_t of_a = faces.size();
  const int begin_b = static_cast<int>(points.size());
  moved.append(region, points, faces);
  if (of_a == 0 || of_a == faces.size()) return false;
  const auto are_of_both = [&](const reference::Intersection& found) {
    return (found.segment[0] < begin_b) != (found.triangle < of_a);
  };
  return std::ranges::any_of(reference::intersections(points, faces, {}), are_of_both);
}

/// True if two surfaces cross each other: if no small displacement, `by` along some direction of each octant,
/// parts them, as it does where they touch, such as a plate that stands on another one.
bool cross(const Surface& a, const Surface& b, double by) {
  if (!meet(a, b, {0.0, 0.0, 0.0})) return false;
  for (int octant = 0; octant < 8; ++octant) {
    const auto along = [&](int axis) { return (octant >> axis & 1) != 0 ? by : -by; };
    if (!meet(a, b, {along(0), 0.83 * along(1), 0.71 * along(2)})) return false;
  }
  return true;
}

Surface surface_at(const mesh::Mesh& mesh, const BodyMotion& motion, double time) {
  return Surface{mesh.rest, mesh.triangles, box_around(mesh.rest)}.moved(motion.at(time));
}

}  // namespace

void check_body_overlaps(const scene::Place& root, FlowScene& scene) {
  if (scene.bodies.size() < 2) return;
  std::vector<BodyMotion> motions(scene.bodies.begin(), scene.bodies.end());
  std::vector<mesh::Mesh> meshes;
  for (const Body& body : scene.bodies) meshes.push_back(mesh_of(body));
  const bool moves = std::ranges::any_of(motions, &BodyMotion::moves);
  constexpr int intervals = 256;
  for (int step = 0; step <= (moves ? intervals : 0); ++step) {
    const double time = scene.end_time * step / intervals;
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < meshes.size(); ++i)
      surfaces.push_back(surface_at(meshes[i], motions[i], time));
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Body &body = scene.bodies[i], &other = scene.bodies[k];
        const bool move_together = body.motion == other.motion;
        if (step > 0 && move_together) continue;
        const double edge = std::min(body.largest_edge(), other.largest_edge());
        if (!cross(surfaces[i], surfaces[k], displacement * edge)) continue;
        const scene::Place at = root.at("body", i);
        if (!move_together)
          at.contradict(body.moves() ? "motion" : "centre", at.path(), " crosses ", scene::element("body", k),
                        " at t = ", time,
                        " s: bodies that move against each other may touch, and not overlap");
        scene.note(at.path(), " overlaps ", scene::element("body", k),
                   ": each has a share of the force on both together");
      }
  }
}

void check_canopies_beside_bodies(const scene::Place& root, const FlowScene& scene, const Sheets& sheets) {
  if (scene.bodies.empty() || scene.canopies.empty()) return;
  const SheetParts parts = parts_of(scene.bodies, sheets);
  for (const reference::Intersection& found :
       reference::intersections(sheets.positions, sheets.fabric.mesh.triangles, sheets.fabric.mesh.lines)) {
    const std::size_t one = parts.of(found.segment[0]),
                      other = parts.of(sheets.fabric.mesh.triangles[found.triangle][0]),
                      body = std::min(one, other), canopy = std::max(one, other);
    if (body < parts.bodies && canopy >= parts.bodies)
      root.contradict(parts.name(canopy) + ".centre", parts.name(canopy), " with its lines crosses ",
                      parts.name(body), " at the start: cloth and lines cannot pass a body");
  }
}

}  // namespace drogue::parachute_app
