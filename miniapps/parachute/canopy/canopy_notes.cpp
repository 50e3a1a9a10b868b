#include <algorithm>
#include <cmath>
#include <numbers>

#include "miniapps/parachute/scene/exchange.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using flow::BoundaryKind;
using scene::element, scene::joined, scene::Place, scene::rough_text, scene::sentence;
using std::numbers::pi;

/// Least number of cells across an open canopy whose forces hardly depend on them.
constexpr double least_cells = 12.0;

/// Diameter of an open canopy, m: two thirds of the nominal one, as of flat circular canopies (0.64 to 0.70,
/// Knacke, Parachute Recovery Systems Design Manual, 1992).
double inflated_diameter(const Canopy& canopy) { return 0.67 * canopy.nominal_diameter(); }

/// Cells across an open canopy.
double cells_across(const flow::Parameters& p, const Canopy& canopy) {
  double width = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) width = std::max(width, core_width(p, axis));
  return inflated_diameter(canopy) / width;
}

void note_blockage(FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  double area = 0.0;
  for (const Canopy& canopy : scene.canopies)
    if (canopy.has_lines()) area += pi / 4.0 * std::pow(inflated_diameter(canopy), 2);
  const double section = (p.high[0] - p.low[0]) * (p.high[1] - p.low[1]);
  if (area <= most_blockage * section) return;
  scene.note("grid.domain: ", scene.canopies.size() > 1 ? "open canopies cover " : "the open canopy covers ",
             rough_text(100.0 * area / section),
             " % of its section across z, so that drag and speed are those in "
             "a duct and not in free air; a square section of ",
             rough_text(std::ceil(std::sqrt(area / most_blockage))), " m has at most ",
             rough_text(100.0 * most_blockage), " %");
}

/// Notes a drop in a grid at rest, out of which it falls, and sides across the stream along which a grid does
/// not follow a canopy that glides.
void note_unfollowed_canopies(FlowScene& scene) {
  if (scene.drop && scene.frame != Frame::follow)
    scene.note(
        "grid.frame: a drop falls out of a grid at rest, which ends the run; \"follow\" moves the grid with "
        "it");
  const CanopyPayload& payload = scene.canopies.front().payload;
  if (scene.frame != Frame::follow || payload.fixed || payload.guided) return;
  std::vector<std::string> axes, sides;
  for (const std::size_t axis : {0U, 1U}) {
    if (scene.open_axes()[axis]) continue;
    axes.emplace_back(axis_names[axis]);
    sides.push_back(sentence(axis_names[axis], " = \"outflow\""));
  }
  if (axes.empty()) return;
  scene.note("grid.boundary: the grid does not follow canopy[0] along ", joined(axes, " and "),
             ", and a free canopy glides: it may leave the grid, which ends the run; with ",
             joined(sides, ", "), " the grid follows");
}

/// Notes the canopy with the fewest cells across.
void note_coarse_cells(const Place& at, FlowScene& scene, const Canopy& canopy) {
  const double diameter = inflated_diameter(canopy), cells = cells_across(scene.parameters, canopy);
  if (cells >= 0.996 * least_cells) return;  // three digits of them are those of the least number
  scene.note("grid: ", rough_text(cells), " cells across the ", rough_text(diameter), " m of ", at.path(),
             " once it is open are too few for forces that hardly depend on them; cells of ",
             rough_text(diameter / least_cells), " m would be ", rough_text(least_cells));
}

/// Notes free edges that act beyond the cloth: docs/coupling.md, inset of free edges.
void note_wide_edges(FlowScene& scene, double cells) {
  if (edge_inset(scene) > 0.0) return;
  const double width = standard_edge_inset(scene);
  scene.note("coupling.edge_inset = 0: skirt and vent act on the air ", rough_text(width),
             " cells beyond the cloth, so that drag is some ",
             std::lround(100.0 * (std::pow(1.0 + 2.0 * width / cells, 2) - 1.0)),
             " % too large; coupling.edge_inset = ", rough_text(width), " makes up for it");
}

/// Notes a domain that ends within two open diameters behind a canopy, where its wake still acts on it.
void note_short_wake(const Place& at, FlowScene& scene, const Canopy& canopy) {
  constexpr double least_diameters = 2.0;
  const flow::Parameters& p = scene.parameters;
  const bool flows_down = constant_value(scene.velocity[2]).value_or(0.0) < 0.0;
  const double behind = flows_down ? canopy.centre[2] - p.low[2] : p.high[2] - canopy.centre[2],
               least = least_diameters * inflated_diameter(canopy);
  if (behind >= least) return;
  scene.note("grid.domain ends ", rough_text(behind), " m behind the skirt of ", at.path(),
             ", in a wake that still acts on it; at least ", rough_text(least), " m are two open diameters");
}

/// Notes lines with which a flat canopy has more drag than published ones: docs/parachute-notebook.md, length
/// of the lines.
void note_long_lines(const Place& at, FlowScene& scene, const Canopy& canopy) {
  constexpr double longest = 0.95;  // diameters
  const double ratio = canopy.lines.length / canopy.diameter;
  const bool is_default = !at.given("lines.length");  // the next note is on these
  if (is_default || canopy.kind != CanopyKind::flat_circular || ratio <= longest) return;
  scene.note(
      at.path("lines.length"), ": ", rough_text(ratio),
      " diameters: such flat canopies sway here and have a drag coefficient of 0.9 and more, where 0.75 to "
      "0.80 are published and lines of 0.7 to 0.8 diameters have 0.8");
}

/// Notes a perturbation that strains the cloth so far that it springs apart: docs/parachute-notebook.md,
/// inflation.
void note_strained_start(const Place& at, FlowScene& scene, const Canopy& canopy) {
  constexpr double most = 0.05;  // of an edge
  const double amplitude = canopy.perturbation.amplitude, edge = canopy.edge_length;
  if (amplitude <= 1.005 * most * edge) return;  // three digits of the limit are within it
  scene.note(at.path("perturbation.amplitude"), " = ", rough_text(amplitude), " m is ",
             rough_text(100.0 * amplitude / edge),
             " % of edge_length: cloth strained so far springs apart as it starts, "
             "which changes the opening, and may pull harder than that does; at most ",
             rough_text(100.0 * most), " %, here ", rough_text(most * edge), " m, do not");
}

bool blows_along(const FlowScene& scene, std::size_t axis) {
  return constant_value(scene.velocity[axis]).value_or(0.0) != 0.0;
}

/// Notes sides that hold the stream up or the air together.
void note_sides(FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  std::vector<std::string> closed, walls;
  for (std::size_t side = 0; side < 6; ++side) {
    const BoundaryKind kind = p.boundary[side].kind;
    if (kind == BoundaryKind::wall)
      walls.emplace_back(side_names[side]);
    else if (!is_open(kind) &&
             (side >= 4 || (kind != BoundaryKind::periodic && blows_along(scene, side / 2))))
      closed.emplace_back(side_names[side]);
  }
  if (!walls.empty())
    scene.note("grid.boundary: walls at ", joined(walls, " and "),
               " hold the air back, so that drag and speed are not those in free air; "
               "\"slip\" sides, far away, do not");
  if (!closed.empty())
    scene.note(
        "grid.boundary: no air passes ", joined(closed, " and "),
        ", so that a canopy drives the air of the domain along and its drag and speed are not those in "
        "free air; [\"inflow\", \"outflow\"] along the stream lets it pass");
}

/// Notes a canopy that does not trail its payload in the air that meets it at the start.
void note_axis_across_the_air(const Place& at, FlowScene& scene, const Canopy& canopy) {
  constexpr double largest_angle = 80.0;  // degrees: the largest of [Shi] is 75
  const auto stream = scene.stream();
  if (!stream) return;
  const fabric::Vector payload = payload_place(canopy);
  double along = 0.0, length = 0.0, speed = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double up = canopy.centre[axis] - payload[axis],
                 air = (*stream)[axis] - canopy.start_velocity[axis];
    along += up * air;
    length = std::hypot(length, up);
    speed = std::hypot(speed, air);
  }
  if (!(speed > 0.0)) return;
  const double angle = 180.0 / pi * std::acos(std::clamp(along / (length * speed), -1.0, 1.0));
  if (angle <= largest_angle) return;
  scene.note(
      at.path("angle"), ": the air meets the canopy at the start at ", std::lround(angle),
      " degrees from its axis, which leads from the payload to the cloth: it does not trail its payload; "
      "angle and azimuth turn it");
}

/// Notes dimensions of a C-9 that a canopy of another diameter has by default.
void note_defaults_of_another_canopy(const Place& at, FlowScene& scene, const Canopy& canopy) {
  const Canopy standard;
  const double ratio = canopy.diameter / standard.diameter;
  if (std::abs(ratio - 1.0) < 0.05) return;
  std::vector<std::string> defaults, own;
  const auto compare = [&](const char* key, double value, double scaled, const char* unit) {
    if (at.given(key)) return;
    defaults.push_back(sentence(key, " = ", rough_text(value), unit));
    own.push_back(sentence(key, " = ", rough_text(scaled)));
  };
  compare("vent", canopy.vent, ratio * standard.vent, " m");
  compare("gores", canopy.gores, std::max(3.0, std::round(ratio * standard.gores)), "");
  compare("lines.length", canopy.lines.length, ratio * standard.lines.length, " m");
  if (defaults.empty()) return;
  scene.note(at.path(), " is ", rough_text(canopy.diameter), " m wide, but has by default ",
             joined(defaults, ", "), " of a C-9 of ", standard.diameter, " m; in proportion it has ",
             joined(own, ", "));
}

}  // namespace

std::string narrow_core_text(const FlowScene& scene, std::size_t i, double degrees, const char* when) {
  const Canopy& canopy = scene.canopies[i];
  const flow::Parameters& p = scene.parameters;
  const double lean = degrees * pi / 180.0, radius = 0.5 * inflated_diameter(canopy),
               along = std::sqrt(std::max(0.0, std::pow(canopy.lines.length, 2) - radius * radius)) +
                       (canopy.riser ? canopy.riser->length : 0.0);
  const fabric::Vector payload = payload_place(canopy);
  for (const std::size_t axis : {0U, 1U}) {
    if (!flow::is_stretched(p, axis)) continue;
    const bool follows = scene.frame == Frame::follow && scene.open_axes()[axis];
    const auto [low, high] = sheet_extent(p, axis);
    const double pivot = follows ? 0.5 * (payload[axis] + canopy.centre[axis]) : payload[axis],
                 room = std::min(pivot - low, high - pivot) - core_width(p, axis),
                 needed = (follows ? 0.5 : 1.0) * along * std::sin(lean) + radius * std::cos(lean);
    if (room >= needed) continue;
    return sentence(scene.faces ? "grid.faces leave " : "grid.core leaves ", element("canopy", i), " ",
                    rough_text(room), " m along ", axis_names[axis], ", and one that leans by ",
                    rough_text(degrees), " degrees", when, " needs ", rough_text(needed),
                    " m to each side: it may leave the core, which ends the run");
  }
  return {};
}

void note_unfit_canopies(const Place& root, FlowScene& scene) {
  std::vector<std::size_t> flying;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    if (scene.canopies[i].has_lines()) flying.push_back(i);
  if (flying.empty()) return;
  const auto cells = [&](std::size_t i) { return cells_across(scene.parameters, scene.canopies[i]); };
  const std::size_t coarsest = *std::ranges::min_element(flying, {}, cells);
  note_blockage(scene);
  note_sides(scene);
  note_unfollowed_canopies(scene);
  note_coarse_cells(root.at("canopy", coarsest), scene, scene.canopies[coarsest]);
  for (const std::size_t i : flying) {
    const Place at = root.at("canopy", i);
    note_axis_across_the_air(at, scene, scene.canopies[i]);
    note_short_wake(at, scene, scene.canopies[i]);
    if (const std::string text = narrow_core_text(scene, i, expected_lean); !text.empty()) scene.note(text);
    note_long_lines(at, scene, scene.canopies[i]);
    note_strained_start(at, scene, scene.canopies[i]);
    note_defaults_of_another_canopy(at, scene, scene.canopies[i]);
  }
  note_wide_edges(scene, cells(coarsest));
}

}  // namespace drogue::parachute_app
