#include "miniapps/parachute/canopy/canopy_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include "common/scene/node.hpp"
#include "common/scene/read.hpp"
#include "kernels/fabric/contact/features.hpp"
#include "miniapps/parachute/bodies/body_check.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/canopy/stiffness.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using scene::contradict;
using scene::real_text;
using scene::rounded_text;
using scene::Table;

constexpr double most_canopy_vertices = 1048576.0;  // 2^20

std::string name_of(std::size_t index) { return "canopy[" + std::to_string(index) + "]"; }

/// Key that places a canopy.
std::string place_key(const Canopy& canopy, const std::string& name) {
  return name + (canopy.payload.shared ? ".payload.shared" : ".centre");
}

void check_measures(const Table& root, const Canopy& canopy, const std::string& name) {
  if (canopy.vent == 0.0 && canopy.reinforcement.vent > 0.0)
    contradict(root, name + ".reinforcement.vent", name + ".reinforcement.vent: this canopy has no vent");
  if (canopy.vent == 0.0 && canopy.vent_lines)
    contradict(root, name + ".vent_lines", name + ".vent_lines: this canopy has no vent");
  if (canopy.perturbation.amplitude > 0.25 * canopy.edge_length)
    contradict(root, name + ".perturbation.amplitude",
               name + ".perturbation.amplitude = " + real_text(canopy.perturbation.amplitude) +
                   " m exceeds a quarter of edge_length, " + real_text(0.25 * canopy.edge_length) + " m");
  const double radius = canopy.skirt_radius();
  if (canopy.vent >= canopy.diameter)
    contradict(root, name + ".vent",
               name + ".vent = " + real_text(canopy.vent) + " m leaves nothing of a canopy of " +
                   real_text(canopy.diameter) + " m diameter: it must be smaller");
  const double narrowing = std::abs(0.5 * canopy.diameter - radius);
  if (canopy.has_skirt() && canopy.skirt.length < narrowing)
    contradict(root, name + ".skirt.length",
               name + ".skirt.length = " + real_text(canopy.skirt.length) +
                   " m: the skirt does not reach from a radius of " + real_text(0.5 * canopy.diameter) +
                   " m to one of " + real_text(radius) + " m; at least " + real_text(narrowing) + " m");
  if (canopy.has_skirt() && canopy.shape == CanopyShape::partly_closed)
    contradict(
        root, name + ".shape",
        name + ".shape = \"partly-closed\" needs kind = \"flat-circular\", whose cloth folds to a cone");
  if (canopy.kind == CanopyKind::drum && canopy.shape == CanopyShape::partly_closed)
    contradict(root, name + ".shape",
               name + ".shape = \"partly-closed\": a drum is flat but for its deflection");
  if (canopy.kind == CanopyKind::drum && std::abs(canopy.deflection) > 0.5 * radius)
    contradict(root, name + ".deflection",
               name + ".deflection = " + real_text(canopy.deflection) +
                   " m exceeds half of the radius of the drum, " + real_text(0.5 * radius) + " m");
  if (canopy.has_lines() && canopy.lines.length <= radius)
    contradict(root, name + ".lines.length",
               name + ".lines.length = " + real_text(canopy.lines.length) +
                   " m: the lines do not reach the payload from a skirt of " + real_text(radius) +
                   " m radius; they must be longer");
  const double least = std::sin(std::numbers::pi / canopy.gores);
  if (canopy.shape == CanopyShape::partly_closed && canopy.closure <= least)
    contradict(root, name + ".closure",
               name + ".closure = " + real_text(canopy.closure) + ": the folds of " +
                   std::to_string(canopy.gores) + " gores would meet at the axis; it must be larger than " +
                   real_text(least));
}

/// A reefing line that is stretched from the start on would pull the skirt together at once.
void check_reefing(const Table& root, const Canopy& canopy, const std::string& name) {
  if (!canopy.reefing) return;
  const std::string key = name + ".reefing.length";
  const double side = 2.0 * std::sin(std::numbers::pi / canopy.gores),
               around = canopy.gores * side * canopy.starting_skirt_radius(),
               open = canopy.gores * side * canopy.skirt_radius();
  if (canopy.reefing->length < (1.0 - 1e-9) * around)
    contradict(root, key,
               key + " = " + real_text(canopy.reefing->length) +
                   " m is shorter than the skirt at the start, " + real_text(around) +
                   " m around; shape = \"partly-closed\" with a smaller closure shortens it");
  if (canopy.reefing->length >= open)
    contradict(root, key,
               key + " = " + real_text(canopy.reefing->length) + " m does not reef: it must be less than " +
                   real_text(open) + " m, the length around the skirt");
}

/// Cuts after the end of the run would not happen.
void check_cuts(const Table& root, const FlowScene& scene, const Canopy& canopy, const std::string& name) {
  const auto check = [&](const std::string& key, const std::optional<double>& time) {
    if (time && *time > scene.end_time)
      contradict(root, key,
                 key + " = " + real_text(*time) + " s is later than run.end_time = " +
                     real_text(scene.end_time) + " s; a run that continues this one may have it");
  };
  check(name + ".payload.release", canopy.payload.release);
  if (canopy.reefing) check(name + ".reefing.cut", canopy.reefing->cut);
}

void check_edges(const Table& root, const flow::Parameters& p, const Canopy& canopy,
                 const std::string& name) {
  double width = cell_width(p, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.cells[axis] == 1)
      contradict(root, name, name + ": the grid has one cell along " + axis_names[axis]);
    width = std::min(width, cell_width(p, axis));
  }
  const std::string key = name + ".edge_length";
  const double longest = largest_edge_in_cells * width;
  if (canopy.edge_length > (1.0 + 1e-9) * longest)
    contradict(root, key,
               key + " = " + real_text(canopy.edge_length) +
                   " m is too coarse: the cloth leaks on cells of " + real_text(width) + " m; at most " +
                   real_text(longest) + " m");
}

void check_size(const Table& root, const Canopy& canopy, const std::string& name) {
  const std::string key = name + ".edge_length";
  // Counting takes as long as there are rings, of three vertices at least.
  const double along = 0.5 * canopy.diameter + (canopy.has_skirt() ? canopy.skirt.length : 0.0);
  bool is_too_large = 3.0 * along / canopy.edge_length > most_canopy_vertices;
  if (!is_too_large) {
    const std::vector<int> sizes = ring_sizes(canopy);
    is_too_large = std::accumulate(sizes.begin(), sizes.end(), 0.0) > most_canopy_vertices;
  }
  if (is_too_large)
    contradict(root, key,
               key + " = " + real_text(canopy.edge_length) + " m: the vertices are more than 2^20");
}

/// Duration of the first step of the flow, s; 0 if it is not known.
double first_dt(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  if (p.fixed_dt > 0.0) return p.fixed_dt;
  double rate = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto speed = SpaceTimeFunction(scene.initial_velocity()[axis]).constant();
    if (!speed) return 0.0;
    rate += std::abs(*speed) / cell_width(p, axis);
  }
  return rate > 0.0 ? std::min(p.max_dt, scene.cfl() / rate) : p.max_dt;
}

/// Signals are answered between steps of the flow: one must not hold more steps of the cloth than pass within
/// a second or so.
void check_stiffness(const Table& root, const FlowScene& scene, const Canopy& canopy, const CanopyMesh& mesh,
                     const std::string& name) {
  const StiffPart part = stiffest_part(canopy, mesh);
  const double dt = first_dt(scene), steps = part.frequency * dt;
  if (steps <= static_cast<double>(coupling::most_substeps)) return;
  std::ostringstream text;
  text.precision(3);
  text << name << "." << part.key << ": " << part.value << " " << part.unit << " needs some " << steps
       << " steps of the cloth in each step of the flow, of " << dt << " s; at most "
       << coupling::most_substeps << ", with " << part.remedy << " " << part.key
       << ", a larger edge_length or a smaller "
       << (scene.parameters.fixed_dt > 0.0 ? "run.dt" : "run.max_dt");
  contradict(root, name + "." + part.key, text.str());
}

/// The forces of cloth act up to one cell beyond it.
void check_inside(const Table& root, const flow::Parameters& p, const std::vector<Vector>& positions,
                  const std::string& key, const std::string& name) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.boundary[2 * axis].kind == flow::BoundaryKind::periodic) continue;
    const auto [low, high] = std::ranges::minmax(positions, {}, [axis](const Vector& x) { return x[axis]; });
    const double margin = cell_width(p, axis), least = p.low[axis] + margin, most = p.high[axis] - margin;
    const double rounding = 1e-9 * (p.high[axis] - p.low[axis]);
    if (low[axis] >= least - rounding && high[axis] <= most + rounding) continue;
    contradict(root, key,
               name + " with its payload reaches from " + rounded_text(low[axis]) + " to " +
                   rounded_text(high[axis]) + " m along " + axis_names[axis] +
                   ", beyond the cells beside the sides of the domain: it must lie between " +
                   rounded_text(least) + " and " + rounded_text(most) + " m");
  }
}

/// Points of one cloth in the order of x.
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
  for (Vector& x : points)
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] += by[axis];
  return points;
}

/// Checks that no triangles of a canopy cross those of a body or an earlier canopy, or their images beyond
/// periodic sides: then, vertices of both lie within an edge of each other. `cloths`: vertices of the
/// canopies so far, the last one included.
void check_overlaps(const Table& root, const FlowScene& scene, const std::vector<std::vector<Vector>>& cloths,
                    const std::vector<std::vector<Vector>>& bodies) {
  const std::size_t i = cloths.size() - 1;
  const Canopy& canopy = scene.canopies[i];
  const auto check = [&](const std::vector<Vector>& other, double edge_length, const std::string& what) {
    const double distance = canopy.edge_length + edge_length;
    if (are_near(other, cloths[i], distance))
      contradict(root, place_key(canopy, name_of(i)),
                 name_of(i) + " overlaps " + what + " at the start: they come closer than " +
                     real_text(distance) + " m, the sum of their edge lengths");
  };
  const std::string image = "the image, beyond periodic sides, of ";
  std::vector<Vector> periods = scene.has_fluid() ? periods_of(scene.parameters) : std::vector<Vector>{};
  for (const Vector& period : periods)
    check(displaced(cloths[i], period), canopy.edge_length, image + name_of(i));
  for (std::size_t k = periods.size(); k-- > 0;)
    periods.push_back({-periods[k][0], -periods[k][1], -periods[k][2]});
  const auto check_all = [&](const std::vector<Vector>& other, double edge_length, const std::string& what) {
    check(other, edge_length, what);
    for (const Vector& period : periods) check(displaced(other, period), edge_length, image + what);
  };
  for (std::size_t k = 0; k < i; ++k) check_all(cloths[k], scene.canopies[k].edge_length, name_of(k));
  for (std::size_t k = 0; k < bodies.size(); ++k)
    check_all(bodies[k], scene.bodies[k].largest_edge(), "body[" + std::to_string(k) + "]");
}

/// The grid moves with the first payload.
void check_frame(const Table& root, const FlowScene& scene) {
  if (scene.frame != Frame::follow) return;
  const std::string follow = "grid.frame = \"follow\"";
  if (scene.canopies.empty()) contradict(root, "grid.frame", follow + " applies only with a [[canopy]]");
  if (std::ranges::none_of(scene.open_axes(), [](bool open) { return open; }))
    contradict(root, "grid.frame",
               follow + " needs an axis whose sides are \"inflow\" or \"outflow\": the grid moves along it");
  if (!scene.bodies.empty())
    contradict(root, "grid.frame", follow + " cannot be combined with a [[body]], which stays in its place");
  if (!scene.canopies.front().has_lines())
    contradict(root, "grid.frame", follow + " needs a payload; canopy[0] has none");
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    if (scene.canopies[i].payload.fixed && !scene.canopies[i].payload.shared)
      contradict(root, "grid.frame",
                 follow + " needs payloads that move freely; " + name_of(i) + ".payload.fixed is true");
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    for (const std::size_t axis : {0U, 1U})
      if (scene.canopies[i].payload.guided && scene.open_axes()[axis])
        contradict(root, "grid.frame",
                   follow + " moves along " + axis_names[axis] + ", whose sides are open; " + name_of(i) +
                       ".payload.guided keeps the payload from it");
  const auto require_constant = [&](const std::string& key, const VectorExpression& velocity) {
    for (const std::string& component : velocity)
      if (!component.empty() && !SpaceTimeFunction(component).constant())
        contradict(root, key, key + " = " + scene::shortened(component) + " must be a number with " + follow);
  };
  require_constant("fluid.velocity", scene.velocity);
  for (std::size_t side = 0; side < 6; ++side)
    require_constant(std::string("grid.wall_velocity.") + side_names[side], scene.wall_velocity[side]);
}

void check_contact(const Table& root, const FlowScene& scene) {
  if (!scene.contact) return;
  const double height = fabric::shortest_altitude(
      make_all_sheets(scene.bodies, scene.canopies, scene.parameters.density, scene.parameters.viscosity)
          .fabric.mesh);
  if (scene.thickness < height) return;
  contradict(root, "coupling.thickness",
             "coupling.thickness = " + real_text(scene.thickness) +
                 " m must be less than the least height of a triangle, " + real_text(height) +
                 " m, with contact");
}

/// Explicit coupling needs cloth that outweighs the air that moves with it, sharp coupling prescribed motion.
void check_method(const Table& root, const FlowScene& scene) {
  if (scene.coupling.method == coupling::CouplingMethod::sharp)
    contradict(root, "coupling.method",
               "coupling.method = \"sharp\" takes a [[body]] and no [[canopy]]: the force on a free vertex "
               "would jump where cloth passes the centre of a cell");
  if (!scene.is_explicit() || scene.allow_unstable) return;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    const Canopy& canopy = scene.canopies[i];
    const double ratio = scene.added_mass_ratio(canopy);
    if (ratio <= 1.0) continue;
    std::ostringstream text;
    text.precision(3);
    text << "coupling.method = \"explicit\": waves as long as " << name_of(i) << ", " << canopy.diameter
         << " m, move " << ratio * canopy.area_density << " kg/m^2 of fluid, " << ratio << " times the "
         << canopy.area_density
         << " kg/m^2 of its cloth; forces that act a step late need at most 1, \"spread\" takes any cloth";
    contradict(root, "coupling.method", text.str());
  }
}

}  // namespace

void check_and_place_canopies(const Table& root, std::vector<Canopy>& canopies) {
  for (std::size_t i = 0; i < canopies.size(); ++i) {
    const std::optional<int> shared = canopies[i].payload.shared;
    if (!shared) continue;
    const std::string key = name_of(i) + ".payload.shared";
    const std::string given = key + " = " + std::to_string(*shared);
    if (*shared >= static_cast<int>(i))
      contradict(root, key, given + ": it must be the number of an earlier canopy, from 0");
    const Canopy& owner = canopies[static_cast<std::size_t>(*shared)];
    if (owner.payload.shared || !owner.has_lines())
      contradict(root, key, given + ": this canopy has no payload of its own");
    // With risers, the force of each canopy on the payload is that of one line.
    for (const std::size_t of : {static_cast<std::size_t>(*shared), i})
      if (!canopies[of].riser)
        contradict(root, key,
                   "missing key \"" + name_of(of) + ".riser\" (needed with " + key +
                       "): it leads to the common payload");
  }
  place_at_shared_payloads(canopies);
}

void check_canopies(const Table& root, const FlowScene& scene) {
  if (scene.canopies.empty()) return check_frame(root, scene);
  const flow::Parameters& p = scene.parameters;
  std::vector<std::vector<Vector>> cloths, bodies;
  for (const Body& body : scene.bodies) bodies.push_back(sorted_by_x(mesh_of(body).rest));
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    const Canopy& canopy = scene.canopies[i];
    const std::string name = name_of(i);
    check_measures(root, canopy, name);
    check_reefing(root, canopy, name);
    check_cuts(root, scene, canopy, name);
    if (scene.has_fluid()) {
      check_porosity(root, scene, name, canopy.porosity);
      check_edges(root, p, canopy, name);
    }
    check_size(root, canopy, name);
    const Canopy& first = scene.canopies.front();
    if (canopy.membrane_modulus != first.membrane_modulus)
      contradict(root, name + ".membrane_modulus",
                 name + ".membrane_modulus differs from that of canopy[0]; all canopies have the same one");
    if (canopy.poisson != first.poisson)
      contradict(root, name + ".poisson",
                 name + ".poisson differs from that of canopy[0]; all canopies have the same one");
    CanopyMesh mesh = make_canopy(canopy);
    if (scene.has_fluid()) {
      check_stiffness(root, scene, canopy, mesh, name);
      check_inside(root, p, mesh.positions, place_key(canopy, name), name);
    }
    mesh.positions.resize(mesh.cloth_vertices);
    cloths.push_back(sorted_by_x(std::move(mesh.positions)));
    check_overlaps(root, scene, cloths, bodies);
  }
  check_contact(root, scene);
  if (!scene.has_fluid()) return;
  check_frame(root, scene);
  check_method(root, scene);
}

}  // namespace drogue::parachute_app
