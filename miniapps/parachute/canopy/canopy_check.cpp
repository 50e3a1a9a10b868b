#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernels/fabric/contact/features.hpp"
#include "miniapps/parachute/bodies/box.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/canopy/stiffness.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using scene::element, scene::Place, scene::rough_text, scene::rounded_text, scene::sentence;

/// Key that places a canopy.
std::string place_key(const Canopy& canopy) { return canopy.payload.shared ? "payload.shared" : "centre"; }

void check_measures(const Place& at, const Canopy& canopy) {
  const bool has_vent = canopy.vent > 0.0, is_drum = canopy.kind == CanopyKind::drum,
             is_closed = canopy.shape == CanopyShape::partly_closed;
  const double radius = canopy.skirt_radius(), flat_radius = 0.5 * canopy.diameter,
               narrowing = std::abs(flat_radius - radius),
               least_closure = std::sin(std::numbers::pi / canopy.gores);
  at.refuse_if(!has_vent && canopy.reinforcement.vent > 0.0, "reinforcement.vent",
               ": this canopy has no vent");
  at.refuse_if(!has_vent && canopy.vent_lines, "vent_lines", ": this canopy has no vent");
  at.refuse_if(canopy.perturbation.amplitude > 0.25 * canopy.edge_length, "perturbation.amplitude", " = ",
               canopy.perturbation.amplitude, " m exceeds a quarter of edge_length, ",
               0.25 * canopy.edge_length, " m");
  at.refuse_if(canopy.vent >= canopy.diameter, "vent", " = ", canopy.vent,
               " m leaves nothing of a canopy of ", canopy.diameter, " m diameter: it must be smaller");
  at.refuse_if(canopy.has_skirt() && canopy.skirt.length < narrowing, "skirt.length", " = ",
               canopy.skirt.length, " m: the skirt does not reach from a radius of ", flat_radius,
               " m to one of ", radius, " m; at least ", narrowing, " m");
  at.refuse_if(canopy.has_skirt() && is_closed, "shape",
               " = \"partly-closed\" needs kind = \"flat-circular\", whose cloth folds to a cone");
  at.refuse_if(is_drum && is_closed, "shape", " = \"partly-closed\": a drum is flat but for its deflection");
  at.refuse_if(is_drum && std::abs(canopy.deflection) > 0.5 * radius, "deflection", " = ", canopy.deflection,
               " m exceeds half of the radius of the drum, ", 0.5 * radius, " m");
  at.refuse_if(canopy.has_lines() && canopy.lines.length <= radius, "lines.length", " = ",
               canopy.lines.length, " m: the lines do not reach the payload from a skirt of ", radius,
               " m radius; they must be longer");
  at.refuse_if(is_closed && canopy.closure <= least_closure, "closure", " = ", canopy.closure,
               ": the folds of ", canopy.gores, " gores would meet at the axis; it must be larger than ",
               least_closure);
}

/// A reefing line that is stretched from the start on would pull the skirt together at once.
void check_reefing(const Place& at, const Canopy& canopy) {
  if (!canopy.reefing) return;
  const double length = canopy.reefing->length, side = 2.0 * std::sin(std::numbers::pi / canopy.gores),
               around = canopy.gores * side * canopy.starting_skirt_radius(),
               open = canopy.gores * side * canopy.skirt_radius();
  at.refuse_if(length < (1.0 - 1e-9) * around, "reefing.length", " = ", length,
               " m is shorter than the skirt at the start, ", around,
               " m around; shape = \"partly-closed\" with a smaller closure shortens it");
  at.refuse_if(length >= open, "reefing.length", " = ", length, " m does not reef: it must be less than ",
               open, " m, the length around the skirt");
}

/// Cuts after the end of the run would not happen.
void check_cuts(const Place& at, const Canopy& canopy, double end_time) {
  const auto check = [&](const std::string& key, const std::optional<double>& time) {
    if (time && *time > end_time)
      at.refuse(key, " = ", *time, " s is later than run.end_time = ", end_time,
                " s; a run that continues this one may have it");
  };
  check("payload.release", canopy.payload.release);
  if (canopy.reefing) check("reefing.cut", canopy.reefing->cut);
}

void check_edges(const Place& at, const flow::Parameters& p, const Canopy& canopy) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    at.refuse_if(p.cells[axis] == 1, "", ": the grid has one cell along ", axis_names[axis]);
  const double width = least_width(p), longest = largest_edge_in_cells * width;
  at.refuse_if(canopy.edge_length > (1.0 + 1e-9) * longest, "edge_length", " = ", canopy.edge_length,
               " m is too coarse: the cloth leaks on cells of ", width, " m; at most ", longest, " m");
  at.refuse_if(canopy.lines.drag && canopy.lines.drag->diameter > width, "lines.drag.diameter", " = ",
               canopy.lines.drag->diameter, " m is no line on cells of ", width, " m; at most a cell");
}

void check_size(const Place& at, const Canopy& canopy) {
  // Counting takes as long as there are rings, of three vertices at least.
  const double along = 0.5 * canopy.diameter + (canopy.has_skirt() ? canopy.skirt.length : 0.0);
  bool is_too_large = 3.0 * along / canopy.edge_length > most_vertices;
  if (!is_too_large) {
    const std::vector<int> sizes = ring_sizes(canopy);
    is_too_large = std::accumulate(sizes.begin(), sizes.end(), 0.0) > most_vertices;
  }
  at.refuse_if(is_too_large, "edge_length", " = ", canopy.edge_length, " m: the vertices are more than 2^20");
}

/// Signals are answered between steps of the flow: one must not hold more steps of the cloth than pass within
/// a second or so.
void check_stiffness(const Place& at, const FlowScene& scene, const Canopy& canopy, const CanopyMesh& mesh) {
  const StiffPart part = stiffest_part(canopy, mesh);
  const double dt = step_length(scene), steps = part.frequency * dt;
  at.refuse_if(
      !(steps <= static_cast<double>(coupling::most_substeps)), part.key, ": ", rough_text(part.value), " ",
      part.unit, " needs some ", rough_text(steps), " steps of the cloth in each step of the flow, of ",
      rough_text(dt), " s; at most ", coupling::most_substeps, ", with ", part.remedy, " ", part.key,
      ", a larger edge_length or a smaller ", scene.parameters.fixed_dt > 0.0 ? "run.dt" : "run.max_dt");
}

/// Body, or cloth of a canopy.
struct SheetPoints {
  std::string name;
  double edge_length;  ///< m
  bool is_body;
  std::vector<Vector> points;  ///< vertices in the order of x
};

std::vector<Vector> sorted_by_x(std::vector<Vector> points) {
  std::ranges::sort(points);
  return points;
}

/// True if a point of each sheet lies within `distance`, m, of one of the other. The lists are in the order
/// of x.
bool are_near(const std::vector<Vector>& first, const std::vector<Vector>& second, double distance) {
  auto begin = second.begin();
  for (const Vector& a : first) {
    while (begin != second.end() && (*begin)[0] < a[0] - distance) ++begin;
    for (auto b = begin; b != second.end() && (*b)[0] <= a[0] + distance; ++b)
      if (std::hypot(a[0] - (*b)[0], a[1] - (*b)[1], a[2] - (*b)[2]) < distance) return true;
  }
  return false;
}

std::vector<Vector> displaced(std::vector<Vector> points, const Vector& by) {
  for (Vector& x : points) x = parachute_app::displaced(x, by);
  return points;
}

/// Checks that no triangles of a canopy cross those of a body or an earlier canopy, or their images beyond
/// periodic sides: then, vertices of both lie within an edge of each other.
void check_overlaps(const Place& at, const Canopy& canopy, const SheetPoints& own,
                    const std::vector<SheetPoints>& others, const std::vector<Vector>& periods) {
  const auto check = [&](const SheetPoints& other, const Vector& by, const char* image) {
    const double distance = own.edge_length + other.edge_length;
    if (are_near(displaced(other.points, by), own.points, distance))
      at.contradict(place_key(canopy), own.name, " overlaps ", image, other.name,
                    " at the start: they come closer than ", distance, " m, the sum of their edge lengths");
  };
  const char* const image = "the image, beyond periodic sides, of ";
  for (const Vector& period : periods) check(own, period, image);
  for (const SheetPoints& other : others) {
    // The rim of a drum does not move: it may end at a body, such as a plate with a hole.
    if (other.is_body && canopy.kind == CanopyKind::drum) continue;
    check(other, {}, "");
    for (const auto& [x, y, z] : periods) {
      check(other, {x, y, z}, image);
      check(other, {-x, -y, -z}, image);
    }
  }
}

}  // namespace

void check_frame(const Place& root, const FlowScene& scene) {
  if (scene.frame != Frame::follow) return;
  const std::string key = "grid.frame", follow = " = \"follow\"";
  root.refuse_if(scene.canopies.empty(), key, follow, " applies only with a [[canopy]]");
  root.refuse_if(std::ranges::none_of(scene.open_axes(), [](bool open) { return open; }), key, follow,
                 " needs an axis whose sides are \"inflow\" or \"outflow\": the grid moves along it");
  root.refuse_if(!scene.bodies.empty(), key, follow,
                 " cannot be combined with a [[body]], which stays in its place");
  root.refuse_if(!scene.canopies.front().has_lines(), key, follow, " needs a payload; canopy[0] has none");
  for (const auto& [at, canopy] : root.each("canopy", scene.canopies)) {
    root.refuse_if(canopy.payload.fixed && !canopy.payload.shared, key, follow,
                   " needs payloads that move freely; ", at.path("payload.fixed"), " is true");
    for (const std::size_t axis : {0U, 1U})
      root.refuse_if(canopy.payload.guided && scene.open_axes()[axis], key, follow, " moves along ",
                     axis_names[axis], ", whose sides are open; ", at.path("payload.guided"),
                     " keeps the payload from it");
  }
  const auto require_constant = [&](const std::string& of, const VectorExpression& velocity) {
    for (const std::string& component : velocity)
      root.refuse_if(!constant_value(component), of, " = ", scene::shortened(component),
                     " must be a number with ", key, follow);
  };
  require_constant("fluid.velocity", scene.velocity);
  for (std::size_t side = 0; side < 6; ++side)
    require_constant(std::string("grid.wall_velocity.") + side_names[side], scene.wall_velocity[side]);
}

void complete_drop(const Place& root, FlowScene& scene) {
  if (scene.drop && !root.given("coupling.gravity")) scene.gravity = {0.0, 0.0, -9.81};
  const Vector& gravity = scene.gravity;
  const std::optional<Vector> air = scene.has_fluid() ? scene.stream() : Vector{};
  if (scene.drop) {
    root.refuse_if(gravity[0] != 0.0 || gravity[1] != 0.0 || gravity[2] == 0.0, "drop",
                   " needs a coupling.gravity along z");
    root.refuse_if(!air, "drop",
                   " needs a fluid.velocity that does not vary: its speed is relative to the air");
  }
  bool drops = false;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    Canopy& canopy = scene.canopies[i];
    const CanopyPayload& payload = canopy.payload;
    canopy.start_velocity = payload.velocity;
    if (payload.shared) {
      // A wrong number is refused later.
      const auto owner = static_cast<std::size_t>(*payload.shared);
      if (owner < i) canopy.start_velocity = scene.canopies[owner].start_velocity;
      continue;
    }
    const Place at = root.at("canopy", i);
    at.refuse_if(payload.guided && (payload.velocity[0] != 0.0 || payload.velocity[1] != 0.0),
                 "payload.velocity",
                 " is not along z, and payload.guided keeps the payload from moving otherwise");
    if (!scene.drop || !canopy.has_lines()) continue;
    at.refuse_if(payload.fixed, "payload.fixed", " = true: it does not fall, as [drop] wants it");
    drops = true;
    const double angle = scene.drop->angle * std::numbers::pi / 180.0, down = gravity[2] < 0.0 ? -1.0 : 1.0,
                 across = std::abs(scene.drop->angle) == 90.0 ? 0.0 : std::cos(angle);
    root.refuse_if(payload.guided && scene.drop->speed * across != 0.0, "drop.angle", " = ",
                   scene.drop->angle, " degrees: ", at.path("payload.guided"),
                   " keeps the payload on a path of 90 degrees");
    canopy.start_velocity = *air;
    canopy.start_velocity[0] += scene.drop->speed * across;
    canopy.start_velocity[2] += scene.drop->speed * down * std::sin(angle);
    if (payload.guided) canopy.start_velocity[0] = canopy.start_velocity[1] = 0.0;
  }
  root.refuse_if(scene.drop && !drops, "drop", " needs a [[canopy]] with lines and a payload");
}

void check_contact(const Place& root, const FlowScene& scene, const fabric::Mesh& mesh) {
  if (!scene.contact) return;
  const double height = fabric::shortest_altitude(mesh);
  root.refuse_if(!(scene.thickness < height), "coupling.thickness", " = ", scene.thickness,
                 " m must be less than the least height of a triangle, ", height, " m, with contact");
}

void check_method(const Place& root, const FlowScene& scene) {
  const std::string key = "coupling.method";
  root.refuse_if(scene.coupling.method == coupling::CouplingMethod::sharp && !scene.canopies.empty(), key,
                 " = \"sharp\" takes a [[body]] and no [[canopy]]: the force on a free vertex would jump "
                 "where cloth passes the centre of a cell");
  if (!scene.is_explicit() || scene.allow_unstable) return;
  for (const auto& [at, canopy] : root.each("canopy", scene.canopies)) {
    const double ratio = scene.added_mass_ratio(canopy);
    root.refuse_if(!(ratio <= 1.0), key, " = \"explicit\": waves as long as ", at.path(), ", ",
                   rough_text(canopy.diameter), " m, move ", rough_text(ratio * canopy.area_density),
                   " kg/m^2 of fluid, ", rough_text(ratio), " times the ", rough_text(canopy.area_density),
                   " kg/m^2 of its cloth; forces that act a step late need at most 1, \"spread\" takes any "
                   "cloth");
  }
}

/// Checks which canopies share payloads, and places them.
void place_canopies(const Place& root, std::vector<Canopy>& canopies) {
  for (std::size_t i = 0; i < canopies.size(); ++i) {
    const std::optional<int> shared = canopies[i].payload.shared;
    if (!shared) continue;
    const Place at = root.at("canopy", i);
    const std::string key = "payload.shared";
    at.refuse_if(*shared >= static_cast<int>(i), key, " = ", *shared,
                 ": it must be the number of an earlier canopy, from 0");
    const auto payload = static_cast<std::size_t>(*shared);
    at.refuse_if(canopies[payload].payload.shared || !canopies[payload].has_lines(), key, " = ", *shared,
                 ": this canopy has no payload of its own");
    // With risers, the force of each canopy on the payload is that of one line.
    for (const std::size_t of : {payload, i})
      if (!canopies[of].riser)
        at.contradict(key, "missing key \"", element("canopy", of), ".riser\" (needed with ", at.path(key),
                      "): it leads to the common payload");
  }
  place_at_shared_payloads(canopies);
}

void complete_and_check_canopies(const Place& root, FlowScene& scene) {
  place_canopies(root, scene.canopies);
  const flow::Parameters& p = scene.parameters;
  const std::vector<Vector> periods = scene.has_fluid() ? periods_of(p) : std::vector<Vector>{};
  std::vector<SheetPoints> others;
  if (!scene.canopies.empty())
    for (const auto& [at, body] : root.each("body", scene.bodies))
      others.push_back({at.path(), body.largest_edge(), true, sorted_by_x(mesh_of(body).rest)});
  for (const auto& [at, canopy] : root.each("canopy", scene.canopies)) {
    const Canopy& first = scene.canopies.front();
    check_measures(at, canopy);
    check_reefing(at, canopy);
    check_cuts(at, canopy, scene.end_time);
    if (scene.has_fluid()) {
      check_porosity(at, p, canopy.porosity);
      check_edges(at, p, canopy);
    }
    check_size(at, canopy);
    const char* const differs = " differs from that of canopy[0]; all canopies have the same one";
    at.refuse_if(canopy.membrane_modulus != first.membrane_modulus, "membrane_modulus", differs);
    at.refuse_if(canopy.poisson != first.poisson, "poisson", differs);
    CanopyMesh mesh = make_canopy(canopy);
    if (scene.has_fluid()) {
      check_stiffness(at, scene, canopy, mesh);
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (is_bounded(p, axis))
          check_margin(
              at, p, place_key(canopy), at.path() + " with its payload", axis, mesh.positions,
              canopy.has_lines() ? sentence("; its lines.length is ", canopy.lines.length, " m") : "");
    }
    mesh.positions.resize(mesh.cloth_vertices);
    SheetPoints own{at.path(), canopy.edge_length, false, sorted_by_x(std::move(mesh.positions))};
    check_overlaps(at, canopy, own, others, periods);
    others.push_back(std::move(own));
  }
}

}  // namespace drogue::parachute_app
