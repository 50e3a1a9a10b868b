#include "miniapps/parachute/bodies/body_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/scene/read.hpp"
#include "kernels/mesh/orientation.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/parachute/bodies/body_overlap.hpp"
#include "miniapps/parachute/bodies/closed_channel.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using scene::contradict;
using scene::real_text;
using scene::rounded_text;
using scene::Table;

constexpr double most_vertices = 1048576.0;  // 2^20

bool is_bounded(const flow::Parameters& p, std::size_t axis) {
  return p.cells[axis] > 1 && p.boundary[2 * axis].kind != flow::BoundaryKind::periodic;
}

/// Distance that a body keeps from the sides of the domain along an axis, m. The forces of a delta function
/// act up to one cell beyond a sheet; a sharp one acts where it separates the centres of cells.
double margin_of(const FlowScene& scene, const Body& body, std::size_t axis) {
  if (!is_bounded(scene.parameters, axis)) return 0.0;
  const auto extents = body.extents()[axis];
  const bool is_sharp = scene.coupling.method == coupling::CouplingMethod::sharp;
  return is_sharp && extents[0] + extents[1] > 0.0 ? 0.0 : cell_width(scene.parameters, axis);
}

/// Checks the extent of a body along an axis, m. It may cross periodic sides, beyond which it has an image.
/// `at`: the time, where that matters.
void check_extent(const Table& root, const FlowScene& scene, const Body& body, const std::string& key,
                  const std::string& place, std::size_t axis, double low, double high,
                  const std::string& at) {
  const flow::Parameters& p = scene.parameters;
  const double margin = margin_of(scene, body, axis), width = p.high[axis] - p.low[axis];
  const double rounding = 1e-9 * width;
  const std::string reaches = place + " reaches from " + rounded_text(low) + " to " + rounded_text(high) +
                              " m along " + axis_names[axis] + at;
  if (p.cells[axis] > 1 && !is_bounded(p, axis)) {
    if (scene.contact && (low < p.low[axis] - rounding || high > p.high[axis] + rounding))
      contradict(root, key,
                 reaches +
                     ", beyond periodic sides: coupling.contact does not act between a canopy and the image "
                     "of a body; another domain may hold both");
    if (high - low <= width + rounding) return;
    contradict(root, key,
               reaches + " and would cross its image beyond the periodic sides: it must be at most " +
                   real_text(width) + " m long");
  }
  if (low >= p.low[axis] + margin - rounding && high <= p.high[axis] - margin + rounding) return;
  const bool can_be_sharp = margin > 0.0 && scene.coupling.method != coupling::CouplingMethod::sharp &&
                            !body.mount && scene.canopies.empty() && scene.flags.empty();
  contradict(root, key,
             reaches + ", beyond " +
                 (margin > 0.0 ? "the cells beside the sides of the domain" : "the domain") +
                 ": it must lie between " + rounded_text(p.low[axis] + margin) + " and " +
                 rounded_text(p.high[axis] - margin) + " m" +
                 (can_be_sharp ? "; periodic sides it may cross, and with coupling.method = \"sharp\" it may "
                                 "touch all sides along which it extends"
                               : ""));
}

/// Checks that a body spans the single cell of a grid in two dimensions.
void check_two_dimensions(const Table& root, const flow::Parameters& p, const Body& body,
                          const std::string& name) {
  const auto along = static_cast<std::size_t>(body.axis);
  const auto must_span = [&](std::size_t axis, double length, const std::string& key) {
    const double width = p.high[axis] - p.low[axis];
    if (p.cells[axis] == 1 && length < (1.0 - 1e-9) * width)
      contradict(root, key,
                 key + " is " + real_text(length) + " m along " + axis_names[axis] +
                     ", where the grid has one cell: it must be the width of the domain, " +
                     real_text(width) + " m");
  };
  if (body.kind == BodyKind::plate) {
    if (p.cells[along] == 1)
      contradict(root, name + ".normal", name + ".normal: the grid has one cell along " + axis_names[along]);
    for (std::size_t k = 0; k < 2; ++k) must_span(body.axes()[k], body.lengths[k], name + ".lengths");
    return;
  }
  if (body.kind == BodyKind::cylinder) must_span(along, body.length, name + ".length");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.cells[axis] > 1 || (body.kind == BodyKind::cylinder && axis == along && !body.has_ends)) continue;
    contradict(root, body.kind == BodyKind::cylinder ? name + ".axis" : name + ".kind",
               name + (body.kind == BodyKind::cylinder ? ".axis" : ".kind") +
                   ": the grid has one cell along " + axis_names[axis] +
                   ", which only a plate or an open cylinder along " + axis_names[axis] + " spans");
  }
}

/// The vertices of a plate on a spring move independently. It is rigid where it moves all of the fluid.
void check_mount(const Table& root, const FlowScene& scene, const Body& body, const std::string& name) {
  if (!body.mount) return;
  const flow::Parameters& p = scene.parameters;
  const std::string key = name + ".mount";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (is_bounded(p, axis))
      contradict(root, key,
                 key + ": the plate must close a channel with periodic sides; those along " +
                     axis_names[axis] + " are not");
    if (static_cast<int>(axis) == body.axis) continue;
    const double length = body.lengths[axis == body.axes()[0] ? 0 : 1], width = p.high[axis] - p.low[axis];
    if (length < (1.0 - 1e-9) * width)
      contradict(root, name + ".lengths",
                 name + ".lengths: a plate with a mount must close the channel, which is " +
                     real_text(width) + " m wide along " + axis_names[axis]);
  }
  if (scene.coupling.filter == 0.0)
    contradict(
        root, "coupling.filter",
        "coupling.filter = 0: " + name +
            " with its mount would move the fluid beside it alone, and not that of the channel; it must "
            "be positive");
  const double moved = p.density * (p.high[0] - p.low[0]) * (p.high[1] - p.low[1]) * (p.high[2] - p.low[2]);
  if (scene.is_explicit() && !scene.allow_unstable && moved > body.mount->mass)
    contradict(root, "coupling.method",
               "coupling.method = \"explicit\": " + name + " moves all of the fluid, " + real_text(moved) +
                   " kg, more than its own mass, " + real_text(body.mount->mass) +
                   " kg; forces that act a step late are unstable, \"spread\" takes any mass");
  if (!scene.canopies.empty())
    contradict(root, key, key + " cannot be combined with a [[canopy]], whose lines carry no compression");
}

/// Checks the lengths of edges against the cells along each axis.
void check_edges(const Table& root, const flow::Parameters& p, const Body& body, const std::string& name) {
  const std::string key = name + (body.kind == BodyKind::file ? ".file" : ".edge_length");
  const double vertices = body.vertices();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_plate = body.kind == BodyKind::plate;
    if (p.cells[axis] == 1 || (is_plate && static_cast<int>(axis) == body.axis)) continue;
    double edge = body.largest_edge();
    if (is_plate) {
      const std::size_t k = axis == body.axes()[0] ? 0 : 1;
      edge = body.lengths[k] / body.divisions()[k];
    }
    const double h = cell_width(p, axis);
    if (edge > (1.0 + 1e-9) * largest_edge_in_cells * h)
      contradict(root, key,
                 key + ": edges of " + real_text(edge) + " m along " + axis_names[axis] +
                     " leak on cells of " + real_text(h) + " m; at most " +
                     real_text(largest_edge_in_cells * h) + " m");
  }
  if (vertices > most_vertices)
    contradict(root, key, key + ": " + real_text(vertices) + " vertices are more than 2^20");
}

/// Checks the places that a body reaches at several times of the run.
void check_places(const Table& root, const FlowScene& scene, const Body& body, const std::string& name) {
  const auto extents = body.extents();
  std::array<bool, 3> is_side{};  // of a plate
  if (body.kind == BodyKind::plate)
    for (const std::size_t axis : body.axes()) is_side[axis] = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& text = body.motion[axis];
    const SpaceTimeFunction displacement(text.empty() ? "0" : text);
    for (const double time : displacement.sample_times(scene.end_time)) {
      const double moved = displacement({}, time);
      const std::string at = text.empty() ? "" : " at t = " + real_text(time) + " s",
                        resting = is_side[axis] ? ".lengths" : ".centre",
                        key = name + (text.empty() ? resting : std::string(".motion.") + axis_names[axis]);
      if (!std::isfinite(moved))
        contradict(root, key, key + " = " + scene::shortened(text) + " is not finite" + at);
      check_extent(root, scene, body, key, name, axis, body.centre[axis] + moved - extents[axis][0],
                   body.centre[axis] + moved + extents[axis][1], at);
    }
  }
}

/// Checks that a retraction leaves a body, which only the fluid feels, by a delta function.
void check_retraction(const Table& root, const FlowScene& scene, const Body& body, const std::string& name) {
  if (body.retraction == 0.0) return;
  const std::string key = name + ".retraction";
  if (scene.coupling.method == coupling::CouplingMethod::sharp)
    contradict(root, key,
               key + ": coupling.method = \"sharp\" has no delta function, whose width it makes up for");
  if (scene.contact)
    contradict(root, key, key + ": with coupling.contact, cloth would lie on the smaller body");
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double half = std::ranges::max(body.extents()[axis]); body.shortened_by(axis) > 0.5 * half)
      contradict(root, key,
                 key + ": " + real_text(body.shortened_by(axis)) + " m along " + axis_names[axis] +
                     " are more than half of the " + real_text(half) + " m from the centre to the surface");
}

void check_body(const Table& root, const FlowScene& scene, std::size_t index) {
  const Body& body = scene.bodies[index];
  const std::string name = "body[" + std::to_string(index) + "]";
  check_two_dimensions(root, scene.parameters, body, name);
  check_porosity(root, scene, name, body.porosity);
  check_edges(root, scene.parameters, body, name);
  check_mount(root, scene, body, name);
  check_retraction(root, scene, body, name);
  check_places(root, scene, body, name);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string key = name + ".motion." + axis_names[axis];
    if (body.motion[axis].empty()) continue;
    if (scene.parameters.cells[axis] == 1)
      contradict(root, key, key + ": the grid has one cell along " + axis_names[axis]);
    try {
      static_cast<void>(device_program(body.motion[axis]));
    } catch (const std::invalid_argument& refused) {
      contradict(root, key, key + ": " + refused.what());
    }
  }
}

/// Turns faces so that neighbours have their normals on one side. Which side that is does not matter: a sheet
/// has the same law for flow in both directions.
void orient(const Table& root, FlowScene& scene, const std::string& key, Body& body) {
  const mesh::Orientation sides = orientation_of(body.surface);
  const bool needs_normals = body.slips() || body.porosity.law != PorosityLaw::none;
  if (sides.one_sided && needs_normals)
    contradict(root, key,
               key + ": " + body.file + " has one side, as a Moebius strip, at its triangles " +
                   std::to_string((*sides.one_sided)[0] + 1) + " and " +
                   std::to_string((*sides.one_sided)[1] + 1) + "; slip and porosity need two sides");
  if (sides.one_sided || sides.turns() == 0) return;
  turn(body.surface, sides);
  scene.notices.push_back(key + ": " + std::to_string(sides.turns()) + " of " +
                          std::to_string(body.surface.triangles.size()) + " triangles of " + body.file +
                          " are turned, so that neighbours have their normals on one side");
}

/// Reads the mesh file of a body.
void read_surface(const Table& root, FlowScene& scene, std::size_t index) {
  Body& body = scene.bodies[index];
  if (body.kind != BodyKind::file) return;
  const std::string key = "body[" + std::to_string(index) + "].file";
  const std::string scale = "body[" + std::to_string(index) + "].scale";
  body.surface = framework::read_obj(root, {key, scale, body.scale}, scene.file, body.file, scene.notices);
  if (!body.surface.lines.empty() || body.surface.triangles.empty())
    contradict(root, key,
               key + ": " + body.file + " has " +
                   (body.surface.triangles.empty() ? "no face" : "lines (l), which have no area"));
  orient(root, scene, key, body);
}

/// A sharp sheet acts on the velocity through it alone: the fluid slips along flat ones, and not along the
/// steps of faces that stand for others.
void check_slip(const Table& root, const FlowScene& scene) {
  if (scene.coupling.method != coupling::CouplingMethod::sharp) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.mount)
      contradict(root, "body[" + std::to_string(i) + "].mount",
                 "body[" + std::to_string(i) +
                     "].mount: coupling.method = \"sharp\" needs bodies at rest or in prescribed motion");
    const bool is_flat = body.kind == BodyKind::plate || body.kind == BodyKind::disk;
    if (body.slips() == is_flat) continue;
    const std::string key = "body[" + std::to_string(i) + "].slip";
    contradict(
        root, key,
        key + " = " + (is_flat ? "false" : "true") + ": with coupling.method = \"sharp\" the fluid " +
            (is_flat ? "slips along plates and disks" : "cannot slip along the steps of a curved sheet"));
  }
}

}  // namespace

void complete_and_check_bodies(const Table& root, FlowScene& scene) {
  if (scene.bodies.empty()) return;
  const auto spacing = lattice_of(scene.parameters, flow::StateField::pressure).spacing;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    scene.bodies[i].slip = scene.bodies[i].slips();
    scene.bodies[i].spacing = spacing;
    read_surface(root, scene, i);
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) check_body(root, scene, i);
  check_slip(root, scene);
  check_closed_channels(root, scene);
  check_body_overlaps(root, scene);
}

void check_porosity(const Table& root, const FlowScene& scene, const std::string& name,
                    const Porosity& porosity) {
  const coupling::PorousLaw law = law_of(porosity, scene.parameters.density, scene.parameters.viscosity);
  if (!law.impermeable && law.alpha == 0.0 && law.beta == 0.0)
    contradict(root, name + ".porosity",
               name +
                   ".porosity: alpha and beta are 0, so that the fluid passes without a pressure difference "
                   "and the sheet is no obstacle; one of them must be positive, and law = \"none\" is "
                   "impermeable");
  constexpr double most = 1e100;
  if (law.alpha <= most && law.beta <= most) return;
  contradict(root, name + ".porosity",
             name + ".porosity: alpha = " + real_text(law.alpha) + " Pa s/m and beta = " +
                 real_text(law.beta) + " Pa s^2/m^2 follow from it; at most " + rounded_text(most));
}

}  // namespace drogue::parachute_app
