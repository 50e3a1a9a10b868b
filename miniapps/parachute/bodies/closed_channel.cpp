#include "miniapps/parachute/bodies/closed_channel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using flow::BoundaryKind;

/// Section of the domain normal to an axis.
class Section {
 public:
  Section(const flow::Parameters& p, std::size_t axis)
      : _p(p),
        _cells(lattice_of(p)),
        _across((axis + 1) % 3),
        _last((axis + 2) % 3),
        _is_covered(cells(_across) * cells(_last)) {}

  [[nodiscard]] double area() const { return length_of(_p, _across) * length_of(_p, _last); }
  [[nodiscard]] bool is_covered() const {
    return std::ranges::all_of(_is_covered, [](char covered) { return covered != 0; });
  }

  /// Part of the area whose cells are covered.
  [[nodiscard]] double covered_part() const {
    double covered = 0.0;
    for (std::size_t i = 0; i < _is_covered.size(); ++i)
      if (_is_covered[i] != 0)
        covered += _cells.widths[_across][i % cells(_across)] * _cells.widths[_last][i / cells(_across)];
    return covered / static_cast<double>(_is_covered.size());
  }

  /// Covers the cells whose centre line a triangle crosses, also beyond periodic sides. Returns its projected
  /// area, m^2.
  double cover(const std::array<int, 3>& triangle, const std::vector<mesh::Vector>& positions) {
    std::array<mesh::Vector, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) corner[k] = positions[static_cast<std::size_t>(triangle[k])];
    const auto side = [&](std::size_t from, std::size_t to, double a, double b) {
      const double along = corner[to][_across] - corner[from][_across],
                   up = corner[to][_last] - corner[from][_last];
      return along * (b - corner[from][_last]) - up * (a - corner[from][_across]);
    };
    const double doubled = side(0, 1, corner[2][_across], corner[2][_last]);
    const auto [a_first, a_last] = range(corner, _across);
    const auto [b_first, b_last] = range(corner, _last);
    const double rounding = 1e-9 * std::abs(doubled), sign = doubled < 0.0 ? -1.0 : 1.0;
    for (double i = a_first; i <= a_last; i += 1.0)
      for (double j = b_first; j <= b_last; j += 1.0) {
        const double a = centre(_across, i), b = centre(_last, j);
        const bool is_inside = sign * side(0, 1, a, b) >= -rounding && sign * side(1, 2, a, b) >= -rounding &&
                               sign * side(2, 0, a, b) >= -rounding;
        if (is_inside) mark(i, j);
      }
    return 0.5 * std::abs(doubled);
  }

 private:
  [[nodiscard]] std::size_t cells(std::size_t axis) const { return static_cast<std::size_t>(_p.cells[axis]); }
  [[nodiscard]] double centre(std::size_t axis, double index) const {
    if (!flow::is_stretched(_p, axis)) return _p.low[axis] + (index + 0.5) * flow::cell_width(_p, axis, 0);
    return _cells.coordinates[axis][static_cast<std::size_t>(index)];
  }
  [[nodiscard]] std::array<double, 2> range(const std::array<mesh::Vector, 3>& corner,
                                            std::size_t axis) const {
    const auto [low, high] = std::minmax({corner[0][axis], corner[1][axis], corner[2][axis]});
    if (flow::is_stretched(_p, axis)) {  // sheets lie in its core, far from images beyond its sides
      const std::vector<double>& centres = _cells.coordinates[axis];
      const auto first = std::ranges::lower_bound(centres, low),
                 end = std::ranges::upper_bound(centres, high);
      return {static_cast<double>(first - centres.begin()), static_cast<double>(end - centres.begin()) - 1.0};
    }
    const auto index = [&](double x) { return (x - _p.low[axis]) / flow::cell_width(_p, axis, 0) - 0.5; };
    return {std::ceil(index(low) - 1e-9), std::floor(index(high) + 1e-9)};
  }
  void mark(double i, double j) {
    const double n = _p.cells[_across], m = _p.cells[_last];
    const auto is_outside = [&](std::size_t axis, double index) {
      return _p.boundary[2 * axis].kind != BoundaryKind::periodic && (index < 0.0 || index >= _p.cells[axis]);
    };
    if (is_outside(_across, i) || is_outside(_last, j)) return;
    const auto a = static_cast<std::size_t>(i - n * std::floor(i / n)),
               b = static_cast<std::size_t>(j - m * std::floor(j / m));
    _is_covered[a + cells(_across) * b] = 1;
  }

  const flow::Parameters& _p;
  Lattice _cells;
  std::size_t _across, _last;
  std::vector<char> _is_covered;
};

/// True if the fluid of a channel along an axis cannot leave it sideways.
bool has_sides(const flow::Parameters& p, std::size_t axis) {
  for (const std::size_t across : {(axis + 1) % 3, (axis + 2) % 3})
    for (const std::size_t side : {2 * across, 2 * across + 1})
      if (is_open(p.boundary[side].kind)) return false;
  return p.cells[axis] > 1;
}

/// Covers a section by a body. Returns the projected area of its triangles, m^2.
double cover(Section& section, const Body& body) {
  const mesh::Mesh mesh = mesh_of(body);
  double area = 0.0;
  for (const auto& corners : mesh.triangles) area += section.cover(corners, mesh.rest);
  return area;
}

/// Part of the section normal to an axis that a body covers if it closes the channel along it, else 0.
double closed_part(const flow::Parameters& p, const Body& body, std::size_t axis) {
  if (!has_sides(p, axis)) return 0.0;
  Section section(p, axis);
  const double area = cover(section, body);
  return section.is_covered() ? std::min(1.0, area / section.area()) : 0.0;
}

bool is_flat(const Body& body, const flow::Parameters& p, std::size_t axis) {
  const auto [low, high] = body.extents()[axis];
  return low + high <= 1e-9 * core_width(p, axis);
}

/// True if the sides of an axis leave the mean velocity along it to the forces.
bool is_free(const flow::Parameters& p, std::size_t axis) {
  const BoundaryKind low = p.boundary[2 * axis].kind, high = p.boundary[2 * axis + 1].kind;
  return low == high && (low == BoundaryKind::periodic || low == BoundaryKind::outflow);
}

/// True if fluid must pass a body that closes the channel along an axis with a prescribed flow rate.
bool must_be_passed(const FlowScene& scene, const Body& body, std::size_t axis) {
  const auto* const sides = &scene.parameters.boundary[2 * axis];
  const bool has_inflow = sides[0].kind == BoundaryKind::inflow || sides[1].kind == BoundaryKind::inflow;
  return (has_inflow && constant_value(scene.velocity[axis]) != 0.0) || !constant_value(body.motion[axis]);
}

bool is_impermeable(const Body& body) { return body.porosity.law == PorosityLaw::none; }

/// Bodies normal to an axis within a cell of one of them, itself among them.
std::vector<const Body*> bodies_beside(const FlowScene& scene, const Body& body, std::size_t axis) {
  const flow::Parameters& p = scene.parameters;
  std::vector<const Body*> bodies;
  for (const Body& other : scene.bodies)
    if (is_flat(other, p, axis) && std::abs(other.centre[axis] - body.centre[axis]) <= core_width(p, axis))
      bodies.push_back(&other);
  return bodies;
}

/// True if a body closes the channel along an axis only together with others that lie within a cell of it.
bool are_jointly_closing(const FlowScene& scene, const Body& body, std::size_t axis) {
  const flow::Parameters& p = scene.parameters;
  if (!has_sides(p, axis) || !is_flat(body, p, axis) || closed_part(p, body, axis) > 0.0) return false;
  Section section(p, axis);
  for (const Body* other : bodies_beside(scene, body, axis)) cover(section, *other);
  return section.is_covered();
}

}  // namespace

std::vector<coupling::ClosingSheet> closing_sheets(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  std::vector<coupling::ClosingSheet> sheets;
  std::array<bool, 3> has_impermeable{};
  int begin = 0;
  for (const Body& body : scene.bodies) {
    const int end = begin + static_cast<int>(body.vertices());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (body.mount || !is_flat(body, p, axis)) continue;
      const double part = closed_part(p, body, axis), length = length_of(p, axis);
      if (part == 0.0 || (is_impermeable(body) && (has_impermeable[axis] || !is_free(p, axis)))) continue;
      has_impermeable[axis] = has_impermeable[axis] || is_impermeable(body);
      sheets.push_back(
          {static_cast<int>(axis), begin, end, is_free(p, axis) ? part / (p.density * length) : 0.0,
           is_free(p, axis) ? p.body_force[axis] + p.pressure_drop[axis] / (p.density * length) : 0.0});
    }
    begin = end;
  }
  return sheets;
}

void check_closed_channels(const scene::Place& root, const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const bool has_own_step = p.fixed_dt > 0.0 || root.given("run.max_dt");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string moved;  // by the first impermeable body
    bool has_impermeable = false;
    for (const auto& [at, body] : root.each("body", scene.bodies)) {
      const bool are_several = are_jointly_closing(scene, body, axis);
      if (body.mount || (closed_part(p, body, axis) == 0.0 && !are_several)) continue;
      const std::string closes =
          scene::sentence(are_several ? " with others" : "", " closes the channel along ", axis_names[axis]);
      const auto beside = are_several ? bodies_beside(scene, body, axis) : std::vector{&body};
      at.refuse_if(std::ranges::all_of(beside, [](const Body* other) { return is_impermeable(*other); }) &&
                       !is_free(p, axis) && must_be_passed(scene, body, axis),
                   "", closes,
                   " and is impermeable, while the sides of the domain prescribe how much fluid flows there: "
                   "it would have to pass the body; give it porosity, or another size, or sides that are "
                   "both \"periodic\" or both \"outflow\"");
      if ((are_several || !is_flat(body, p, axis)) && !has_own_step)
        root.contradict("run", "missing key \"run.max_dt\": ", at.path(), closes,
                        ", and is not one flat body normal to ", axis_names[axis],
                        "; its force follows the flow within some ", p.cells[axis], " steps");
      if (!is_impermeable(body) || are_several) continue;
      at.refuse_if(is_free(p, axis) && has_impermeable && moved != body.motion[axis], "", closes,
                   " and is impermeable, as another body that moves otherwise: the fluid between them, which "
                   "is incompressible, would have to pass");
      has_impermeable = true, moved = body.motion[axis];
    }
  }
}

void note_narrow_channels(const scene::Place& root, FlowScene& scene, const Sheets& sheets) {
  constexpr double wide = 0.6;
  const flow::Parameters& p = scene.parameters;
  if (!scene.has_sheets() || p.fixed_dt > 0.0 || root.given("run.max_dt")) return;
  const SheetParts parts = parts_of(scene.bodies, sheets);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!has_sides(p, axis)) continue;
    std::vector<Section> sections(parts.ends.size(), Section(p, axis));
    for (const auto& corners : sheets.fabric.mesh.triangles)
      sections[parts.of(corners[0])].cover(corners, sheets.positions);
    for (std::size_t part = 0; part < sections.size(); ++part) {
      // Of bodies that close a channel, the step is exact or needs a given bound.
      const bool is_body = part < parts.bodies,
                 is_treated = is_body && (scene.bodies[part].mount || sections[part].is_covered());
      if (is_treated || sections[part].covered_part() < wide) continue;
      scene.note(parts.name(part), " covers most of the channel along ", axis_names[axis],
                 is_body ? "" : " at the start",
                 ": its force follows sudden changes of the flow within some ", p.cells[axis],
                 " steps; run.max_dt shortens them");
    }
  }
}

}  // namespace drogue::parachute_app
