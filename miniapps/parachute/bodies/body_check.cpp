#include <algorithm>
#include <cmath>

#include "kernels/mesh/orientation.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Place, scene::rough_text, scene::rounded_text, scene::sentence;

bool is_sharp(const FlowScene& scene) { return scene.coupling.method == coupling::CouplingMethod::sharp; }

/// Distance that a body keeps from the sides of the domain along an axis, m. The forces of a delta function
/// act up to one cell beyond a sheet; a sharp one acts where it separates the centres of cells.
double margin_of(const FlowScene& scene, const Body& body, std::size_t axis) {
  if (!is_bounded(scene.parameters, axis)) return 0.0;
  const auto [to_low, to_high] = body.extents()[axis];
  const bool may_touch = is_sharp(scene) && !flow::is_stretched(scene.parameters, axis);
  return may_touch && to_low + to_high > 0.0 ? 0.0 : core_width(scene.parameters, axis);
}

/// Checks the extent of a body along an axis. It may cross periodic sides, beyond which it has an image.
void check_extent(const Place& at, const FlowScene& scene, const Body& body, const std::string& key,
                  const SheetReach& reach) {
  const flow::Parameters& p = scene.parameters;
  const std::size_t axis = reach.axis;
  if (p.cells[axis] > 1 && !is_bounded(p, axis)) {
    const double width = length_of(p, axis), rounding = 1e-9 * width;
    if (scene.contact && (reach.low < p.low[axis] - rounding || reach.high > p.high[axis] + rounding))
      at.contradict(key, reach_text(reach),
                    ", beyond periodic sides: coupling.contact does not act between a canopy and the image "
                    "of a body; another domain may hold both");
    if (reach.high - reach.low > width + rounding)
      at.contradict(key, reach_text(reach),
                    " and would cross its image beyond the periodic sides: it must be at most ", width,
                    " m long");
    return;
  }
  const double margin = margin_of(scene, body, axis);
  const bool can_be_sharp = !flow::is_stretched(p, axis) && margin > 0.0 && !is_sharp(scene) && !body.mount &&
                            scene.canopies.empty() && scene.flags.empty();
  check_margin(at, p, key, reach, margin,
               can_be_sharp ? "; periodic sides it may cross, and with coupling.method = \"sharp\" it may "
                              "touch all sides along which it extends"
                            : "");
}

/// Checks that a body spans the single cell of a grid in two dimensions.
void check_two_dimensions(const Place& at, const flow::Parameters& p, const Body& body) {
  const auto along = static_cast<std::size_t>(body.axis);
  const bool is_cylinder = body.kind == BodyKind::cylinder;
  const auto must_span = [&](std::size_t axis, double length, const std::string& key) {
    const double width = length_of(p, axis);
    at.refuse_if(p.cells[axis] == 1 && length < (1.0 - 1e-9) * width, key, " is ", length, " m along ",
                 axis_names[axis], ", where the grid has one cell: it must be the width of the domain, ",
                 width, " m");
  };
  if (body.kind == BodyKind::plate) {
    at.refuse_if(p.cells[along] == 1, "normal", ": the grid has one cell along ", axis_names[along]);
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t axis = body.axes()[k];
      must_span(axis, body.lengths[k], "lengths");
      at.refuse_if(p.cells[axis] == 1 && body.hole > 0.0, "hole", ": the grid has one cell along ",
                   axis_names[axis]);
    }
    return;
  }
  if (is_cylinder) must_span(along, body.length, "length");
  for (std::size_t axis = 0; axis < 3; ++axis)
    at.refuse_if(p.cells[axis] == 1 && !(is_cylinder && axis == along && !body.has_ends),
                 is_cylinder ? "axis" : "kind", ": the grid has one cell along ", axis_names[axis],
                 ", which only a plate or an open cylinder along ", axis_names[axis], " spans");
}

/// The vertices of a plate on a spring move independently. It is rigid where it moves all of the fluid.
void check_mount(const Place& root, const Place& at, const FlowScene& scene, const Body& body) {
  if (!body.mount) return;
  const flow::Parameters& p = scene.parameters;
  at.refuse_if(scene.has_stretched_axes(), "mount",
               ": the plate must close a channel with cells of one width");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    at.refuse_if(is_bounded(p, axis), "mount",
                 ": the plate must close a channel with periodic sides; those along ", axis_names[axis],
                 " are not");
    if (static_cast<int>(axis) == body.axis) continue;
    const double length = body.lengths[axis == body.axes()[0] ? 0 : 1], width = length_of(p, axis);
    at.refuse_if(length < (1.0 - 1e-9) * width, "lengths",
                 ": a plate with a mount must close the channel, which is ", width, " m wide along ",
                 axis_names[axis]);
  }
  root.refuse_if(scene.coupling.filter == 0.0, "coupling.filter", " = 0: ", at.path(),
                 " with its mount would move the fluid beside it alone, and not that of the channel; it must "
                 "be positive");
  const double moved = fluid_mass(p);
  root.refuse_if(scene.is_explicit() && !scene.allow_unstable && moved > body.mount->mass, "coupling.method",
                 " = \"explicit\": ", at.path(), " moves all of the fluid, ", moved,
                 " kg, more than its own mass, ", body.mount->mass,
                 " kg; forces that act a step late are unstable, \"spread\" takes any mass");
  at.refuse_if(!scene.canopies.empty(), "mount",
               " cannot be combined with a [[canopy]], whose lines carry no compression");
}

void check_hole(const Place& at, const Body& body) {
  if (body.hole == 0.0) return;
  at.refuse_if(body.lengths[0] != body.lengths[1], "hole", ": the plate must be a square, and lengths are ",
               body.lengths[0], " and ", body.lengths[1], " m");
  at.refuse_if(body.hole >= 0.5 * body.lengths[0], "hole", " = ", body.hole,
               " m leaves no plate within its sides, ", 0.5 * body.lengths[0], " m from the middle");
  at.refuse_if(body.mount.has_value(), "mount",
               ": a plate with a mount must close the channel; this one has a hole");
}

/// Checks the lengths of edges against the cells along each axis.
void check_edges(const Place& at, const flow::Parameters& p, const Body& body) {
  const std::string key = body.kind == BodyKind::file ? "file" : "edge_length";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_plate = body.kind == BodyKind::plate;
    if (p.cells[axis] == 1 || (is_plate && static_cast<int>(axis) == body.axis)) continue;
    const std::size_t k = axis == body.axes()[0] ? 0 : 1;
    const double edge = is_plate && body.hole == 0.0 ? body.lengths[k] / body.divisions()[k]
                                                     : body.largest_edge(),
                 h = core_width(p, axis);
    at.refuse_if(edge > (1.0 + 1e-9) * largest_edge_in_cells * h, key, ": edges of ", edge, " m along ",
                 axis_names[axis], " leak on cells of ", h, " m; at most ", largest_edge_in_cells * h, " m");
  }
  at.refuse_if(body.vertices() > most_vertices, key, ": ", body.vertices(), " vertices are more than 2^20");
}

/// Checks the motion of a body, and the places that it reaches at several times of the run.
void check_places(const Place& at, const FlowScene& scene, const Body& body) {
  const auto extents = body.extents();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& text = body.motion[axis];
    const bool is_side = body.kind == BodyKind::plate && static_cast<int>(axis) != body.axis;
    const std::string key = !text.empty() ? std::string("motion.") + axis_names[axis]
                            : is_side     ? "lengths"
                                          : "centre";
    if (!text.empty()) {
      at.refuse_if(scene.parameters.cells[axis] == 1, key, ": the grid has one cell along ",
                   axis_names[axis]);
      checked_program(at, key, text);
    }
    const SpaceTimeFunction displacement(text);
    for (const double time : displacement.sample_times(scene.end_time)) {
      const double moved = displacement({}, time);
      const std::string when = text.empty() ? "" : sentence(" at t = ", time, " s");
      at.refuse_if(!std::isfinite(moved), key, " = ", scene::shortened(text), " is not finite", when);
      check_extent(at, scene, body, key,
                   {at.path(), axis, body.centre[axis] + moved - extents[axis][0],
                    body.centre[axis] + moved + extents[axis][1], when});
    }
  }
}

/// Checks that a retraction leaves a body, which only the fluid feels, by a delta function.
void check_retraction(const Place& at, const FlowScene& scene, const Body& body) {
  if (body.retraction == 0.0) return;
  const std::string key = "retraction";
  at.refuse_if(is_sharp(scene), key,
               ": coupling.method = \"sharp\" has no delta function, whose width it makes up for");
  at.refuse_if(scene.contact, key, ": with coupling.contact, cloth would lie on the smaller body");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = std::ranges::max(body.extents()[axis]), shorter = body.shortened_by(axis);
    at.refuse_if(shorter > 0.5 * half, key, ": ", shorter, " m along ", axis_names[axis],
                 " are more than half of the ", half, " m from the centre to the surface");
  }
}

/// Notes a round body that acts farther outwards than its surface: docs/bodies.md, retraction.
void note_missing_retraction(const Place& at, FlowScene& scene, const Body& body) {
  const bool is_sphere = body.kind == BodyKind::sphere;
  if (!(is_sphere || body.kind == BodyKind::cylinder) || body.slips() || is_sharp(scene) || scene.contact ||
      at.given("retraction"))
    return;
  const double fit = is_sphere ? 0.3 : 0.2, cells = 2.0 * body.radius / std::ranges::max(body.spacing),
               wider = 1.0 + 2.0 * fit / cells;
  const long excess = std::lround(100.0 * ((is_sphere ? wider * wider : wider) - 1.0));
  if (excess < 2) return;
  scene.note(
      at.path("retraction"), " = 0: on ", rough_text(cells), " cells across, the body acts on the fluid ",
      fit, " cells outside of its surface, so that its drag is some ", excess,
      " % too large; retraction = ", fit, " makes up for it, and retraction = 0 says that none is wanted");
}

/// Reads the surface of a body, and turns its faces so that neighbours have their normals on one side. Which
/// side that is does not matter: a sheet has the same law for flow in both directions.
void read_surface(const Place& at, FlowScene& scene, Body& body) {
  body.surface = framework::read_obj(at, body.scale, scene.file, body.file, scene.notices);
  at.refuse_if(body.surface.triangles.empty(), "file", ": ", body.file, " has no face");
  at.refuse_if(!body.surface.lines.empty(), "file", ": ", body.file, " has lines (l), which have no area");
  const mesh::Orientation sides = orientation_of(body.surface);
  if (sides.one_sided && (body.slips() || body.porosity.law != PorosityLaw::none))
    at.refuse("file", ": ", body.file, " has one side, as a Moebius strip, at its triangles ",
              (*sides.one_sided)[0] + 1, " and ", (*sides.one_sided)[1] + 1,
              "; slip and porosity need two sides");
  if (sides.one_sided || sides.turns() == 0) return;
  turn(body.surface, sides);
  scene.note(at.path("file"), ": ", sides.turns(), " of ", body.surface.triangles.size(), " triangles of ",
             body.file, " are turned, so that neighbours have their normals on one side");
}

/// A sharp sheet acts on the velocity through it alone: the fluid slips along flat ones, and not along the
/// steps of faces that stand for others.
void check_slip(const Place& at, const Body& body) {
  at.refuse_if(body.mount.has_value(), "mount",
               ": coupling.method = \"sharp\" needs bodies at rest or in prescribed motion");
  const bool is_flat = body.kind == BodyKind::plate || body.kind == BodyKind::disk;
  at.refuse_if(body.slips() != is_flat, "slip", is_flat ? " = false" : " = true",
               ": with coupling.method = \"sharp\" the fluid ",
               is_flat ? "slips along plates and disks" : "cannot slip along the steps of a curved sheet");
}

}  // namespace

void complete_and_check_bodies(const Place& root, FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  for (const auto& [at, body] : root.each("body", scene.bodies)) {
    body.slip = body.slips();
    body.spacing = flow::core_of(p).spacing;
    if (body.kind == BodyKind::file) read_surface(at, scene, body);
    check_hole(at, body);
    check_two_dimensions(at, p, body);
    check_porosity(at, p, body.porosity);
    check_edges(at, p, body);
    check_mount(root, at, scene, body);
    check_retraction(at, scene, body);
    note_missing_retraction(at, scene, body);
    check_places(at, scene, body);
    if (is_sharp(scene)) check_slip(at, body);
  }
  check_closed_channels(root, scene);
  check_body_overlaps(root, scene);
}

void check_porosity(const Place& at, const flow::Parameters& p, const Porosity& porosity) {
  const coupling::PorousLaw law = law_of(porosity, p.density, p.viscosity);
  at.refuse_if(!law.impermeable && law.alpha == 0.0 && law.beta == 0.0, "porosity",
               ": alpha and beta are 0, so that the fluid passes without a pressure difference and the sheet "
               "is no obstacle; one of them must be positive, and law = \"none\" is impermeable");
  constexpr double most = 1e100;
  at.refuse_if(!(law.alpha <= most && law.beta <= most), "porosity", ": alpha = ", law.alpha,
               " Pa s/m and beta = ", law.beta, " Pa s^2/m^2 follow from it; at most ", rounded_text(most));
}

}  // namespace drogue::parachute_app
