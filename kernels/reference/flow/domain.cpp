#include "kernels/reference/flow/domain.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace drogue::reference {

using flow::BoundaryKind;

FlowDomain::FlowDomain(flow::Parameters parameters, SideVelocity side_velocity)
    : _parameters(std::move(parameters)), _side_velocity(std::move(side_velocity)) {
  if (!_side_velocity)
    _side_velocity = [sides = _parameters.boundary](std::size_t side, std::size_t component, const Point&,
                                                    double) { return sides[side].velocity[component]; };
}

double FlowDomain::face_coordinate(std::size_t axis, int face) const {
  const flow::Parameters& p = _parameters;
  const int n = p.cells[axis];
  if (p.faces[axis].empty()) return p.low[axis] + face * ((p.high[axis] - p.low[axis]) / n);
  const auto inside = [&](int i) { return p.faces[axis][static_cast<std::size_t>(i)]; };
  if (face >= 0 && face <= n) return inside(face);
  const double length = p.high[axis] - p.low[axis];
  if (!is_bounded(axis)) return face < 0 ? inside(face + n) - length : inside(face - n) + length;
  return face < 0 ? 2.0 * p.low[axis] - inside(-face) : 2.0 * p.high[axis] - inside(2 * n - face);
}

double FlowDomain::coordinate(std::size_t component, std::size_t axis, int face) const {
  if (component == axis) return face_coordinate(axis, face);
  return 0.5 * (face_coordinate(axis, face) + face_coordinate(axis, face + 1));
}

double FlowDomain::width(std::size_t axis, int cell) const {
  return face_coordinate(axis, cell + 1) - face_coordinate(axis, cell);
}

double FlowDomain::distance(std::size_t axis, int cell) const {
  return 0.5 * (face_coordinate(axis, cell + 1) - face_coordinate(axis, cell - 1));
}

double FlowDomain::extent(std::size_t component, std::size_t axis, int face) const {
  return component == axis ? distance(axis, face) : width(axis, face);
}

double FlowDomain::step(std::size_t component, std::size_t axis, int face) const {
  return coordinate(component, axis, face) - coordinate(component, axis, face - 1);
}

double FlowDomain::volume(const GridIndex& cell) const {
  return width(0, cell[0]) * width(1, cell[1]) * width(2, cell[2]);
}

bool FlowDomain::is_bounded(std::size_t axis) const {
  return cells(axis) > 1 && kind(2 * axis) != BoundaryKind::periodic;
}

int FlowDomain::faces(std::size_t component, std::size_t axis) const {
  return cells(axis) + (component == axis && is_bounded(axis) ? 1 : 0);
}

std::size_t FlowDomain::at(std::size_t component, const GridIndex& face) const {
  return static_cast<std::size_t>((face[2] * faces(component, 1) + face[1]) * faces(component, 0) + face[0]);
}

std::size_t FlowDomain::cell_at(const GridIndex& cell) const {
  return static_cast<std::size_t>((cell[2] * cells(1) + cell[1]) * cells(0) + cell[0]);
}

StaggeredField FlowDomain::zero_field() const {
  StaggeredField field;
  for (std::size_t c = 0; c < 3; ++c)
    field[c].assign(static_cast<std::size_t>(faces(c, 0) * faces(c, 1) * faces(c, 2)), 0.0);
  return field;
}

void FlowDomain::for_each_face(const std::function<void(std::size_t, const GridIndex&)>& visit) const {
  for (std::size_t c = 0; c < 3; ++c)
    for (int k = 0; k < faces(c, 2); ++k)
      for (int j = 0; j < faces(c, 1); ++j)
        for (int i = 0; i < faces(c, 0); ++i) visit(c, {i, j, k});
}

void FlowDomain::for_each_cell(const std::function<void(const GridIndex&)>& visit) const {
  for (int k = 0; k < cells(2); ++k)
    for (int j = 0; j < cells(1); ++j)
      for (int i = 0; i < cells(0); ++i) visit({i, j, k});
}

int FlowDomain::side_of(std::size_t component, const GridIndex& face) const {
  if (!is_bounded(component)) return -1;
  if (face[component] == 0) return static_cast<int>(2 * component);
  return face[component] == cells(component) ? static_cast<int>(2 * component + 1) : -1;
}

double FlowDomain::side_velocity(std::size_t side, std::size_t component, const GridIndex& face,
                                 double time) const {
  Point point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == side / 2) continue;
    const int i = face[axis], outermost = i < 0 ? 0 : faces(component, axis) - 1;
    GridIndex inside = face;
    if (!is_bounded(axis)) {
      inside[axis] = ((i % cells(axis)) + cells(axis)) % cells(axis);
    } else if (i < 0 || i > outermost) {
      // Linear continuation of the two outermost values of the component.
      GridIndex second = face;
      inside[axis] = outermost;
      second[axis] = outermost + (i < 0 ? 1 : -1);
      const double last = side_velocity(side, component, inside, time);
      return last + std::abs(i - outermost) * (last - side_velocity(side, component, second, time));
    }
    point[axis] = coordinate(component, axis, inside[axis]);
    if (axis == component && is_bounded(axis) && i == cells(axis)) point[axis] = _parameters.high[axis];
  }
  point[side / 2] = side % 2 == 0 ? _parameters.low[side / 2] : _parameters.high[side / 2];
  return _side_velocity(side, component, point, time);
}

double FlowDomain::normal_velocity(std::size_t side, const GridIndex& face, double time) const {
  return kind(side) == BoundaryKind::slip ? 0.0 : side_velocity(side, side / 2, face, time);
}

double FlowDomain::velocity(const StaggeredField& u, std::size_t component, const GridIndex& face,
                            double time) const {
  // The component's own axis comes last: beyond an edge between sides, the side that the component is
  // tangential to decides.
  for (const std::size_t axis : {(component + 1) % 3, (component + 2) % 3, component}) {
    const int n = cells(axis), i = face[axis];
    GridIndex inside = face;
    if (!is_bounded(axis)) {
      inside[axis] = ((i % n) + n) % n;
      if (inside[axis] != i) return velocity(u, component, inside, time);
      continue;
    }
    const bool normal = axis == component;
    const int last = normal ? n : n - 1;
    if (i >= 0 && i <= last && !(normal && (i == 0 || i == n))) continue;
    const bool high = i >= n;
    const std::size_t side = 2 * axis + (high ? 1 : 0);
    const bool on_side = normal && i == (high ? n : 0);
    if (kind(side) == BoundaryKind::outflow) {
      if (on_side) continue;
      inside[axis] = high ? last : 0;
      return velocity(u, component, inside, time);
    }
    if (on_side) return normal_velocity(side, face, time);
    // Mirror image: about a face for normal, between two cells for tangential components.
    inside[axis] = (high ? 2 * n : 0) - i - (normal ? 0 : 1);
    const double image = velocity(u, component, inside, time);
    if (kind(side) == BoundaryKind::slip) return normal ? -image : image;
    return 2.0 * side_velocity(side, component, face, time) - image;
  }
  return u[component][at(component, face)];
}

std::vector<double> divergence(const FlowDomain& domain, const StaggeredField& u) {
  std::vector<double> result;
  domain.for_each_cell([&](const GridIndex& cell) {
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (domain.cells(axis) == 1) continue;
      GridIndex next = cell;
      next[axis] = (cell[axis] + 1) % domain.faces(axis, axis);
      sum +=
          (u[axis][domain.at(axis, next)] - u[axis][domain.at(axis, cell)]) / domain.width(axis, cell[axis]);
    }
    result.push_back(sum);
  });
  return result;
}

StaggeredField pressure_gradient(const FlowDomain& domain, const std::vector<double>& pressure) {
  StaggeredField gradient = domain.zero_field();
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    if (domain.cells(c) == 1) return;
    const std::size_t place = domain.at(c, face);
    const int side = domain.side_of(c, face);
    GridIndex below = face;
    below[c] -= 1;
    if (side < 0) {
      below[c] = (below[c] + domain.cells(c)) % domain.cells(c);
      gradient[c][place] =
          (pressure[domain.cell_at(face)] - pressure[domain.cell_at(below)]) / domain.distance(c, face[c]);
    } else if (domain.kind(static_cast<std::size_t>(side)) == BoundaryKind::outflow) {
      gradient[c][place] = side % 2 == 0
                               ? pressure[domain.cell_at(face)] / (0.5 * domain.width(c, face[c]))
                               : -pressure[domain.cell_at(below)] / (0.5 * domain.width(c, below[c]));
    }
  });
  return gradient;
}

}  // namespace drogue::reference
