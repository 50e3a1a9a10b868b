#include "miniapps/parachute/bodies/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/mesh/round_surfaces.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

/// Number of edges of at most `edge`, m, along a length, m. A real number: it may exceed any integer.
double edges_along(double length, double edge) {
  return std::max(1.0, std::ceil(length / edge * (1.0 - 1e-9)));
}

/// Square plate from its round hole to its sides: a tube that is laid flat. Multiples of eight columns have
/// vertices at the corners.
mesh::Mesh plate_with_hole(const Body& body, int columns, int rows) {
  mesh::Mesh plate = mesh::tube(1.0, 1.0, columns, rows);
  for (mesh::Vector& x : plate.rest) {
    const double side = 0.5 * body.lengths[0] / std::max(std::abs(x[0]), std::abs(x[1])),
                 outwards = 0.5 + x[2], radius = body.hole + outwards * (side - body.hole);
    x = {radius * x[0], radius * x[1], 0.0};
  }
  return plate;
}

mesh::Mesh local_mesh(const Body& body) {
  const auto [first, second] = body.divisions();
  const int n = static_cast<int>(first), rows = static_cast<int>(second);
  switch (body.kind) {
    case BodyKind::plate: {
      if (body.hole > 0.0) return plate_with_hole(body, n, rows);
      mesh::Mesh plate = mesh::rectangle(body.lengths[0], body.lengths[1], n, rows);
      for (mesh::Vector& x : plate.rest) x[0] -= 0.5 * body.lengths[0], x[1] -= 0.5 * body.lengths[1];
      return plate;
    }
    case BodyKind::disk:
      return mesh::disk(body.radius, n);
    case BodyKind::sphere:
      return mesh::sphere(body.radius, n);
    case BodyKind::cylinder:
      return body.has_ends ? mesh::closed_cylinder(body.radius, body.length, n, rows)
                           : mesh::tube(body.radius, body.length, n, rows);
    case BodyKind::cup:
      return mesh::hemisphere(body.radius, n);
    case BodyKind::file:
      return body.surface;
  }
  return {};
}

/// Coordinates x, y, z of `local_mesh` along the axes of the domain: z along that of the body.
mesh::Vector turned(const Body& body, const mesh::Vector& x) {
  if (body.kind == BodyKind::file) return x;
  const auto axis = static_cast<std::size_t>(body.axis);
  mesh::Vector result{};
  if (body.kind == BodyKind::plate) {
    const auto [first, second] = body.axes();
    result[first] = x[0], result[second] = x[1], result[axis] = x[2];
  } else {
    const double sign = body.kind == BodyKind::cup && body.opens_to_high ? -1.0 : 1.0;
    result[(axis + 1) % 3] = x[0], result[(axis + 2) % 3] = sign * x[1], result[axis] = sign * x[2];
  }
  return result;
}

void add_motions(const Body& body, int first, fabric::Parameters& sheets) {
  std::vector<int> vertices(static_cast<std::size_t>(body.vertices()));
  for (std::size_t k = 0; k < vertices.size(); ++k) vertices[k] = first + static_cast<int>(k);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string& text = body.motion[static_cast<std::size_t>(axis)];
    if (!text.empty()) sheets.motions.push_back({axis, vertices, device_program(text)});
  }
}

/// Lets the vertices of a plate move along its normal, each on a spring of its own to a fixed vertex, with
/// their shares of mass and stiffness by area. The springs are linear: the vertices do not move sideways.
void add_springs(const Body& body, std::size_t first, fabric::Parameters& sheets) {
  const mesh::Mesh plate = mesh_of(body);
  const double area = body.lengths[0] * body.lengths[1];
  const std::vector<double> shares = fabric::lumped_masses(plate, 1.0 / area, 0.0, fabric::Lumping::area);
  const auto normal = static_cast<std::size_t>(body.axis);
  // Any distance that the displacements stay below.
  const double distance = 100.0 * (body.lengths[0] + body.lengths[1] + std::abs(body.mount->offset));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const std::size_t vertex = first + k;
    sheets.mass[vertex] = shares[k] * body.mount->mass;
    sheets.pinned[vertex] = static_cast<std::uint8_t>(7U & ~(1U << normal));
    mesh::Vector fixed_end = sheets.mesh.rest[vertex];
    fixed_end[normal] -= distance;
    sheets.mesh.lines.push_back({static_cast<int>(vertex), static_cast<int>(sheets.mesh.rest.size())});
    sheets.mesh.line_stiffness.push_back(shares[k] * body.mount->stiffness * distance);
    sheets.mesh.rest.push_back(fixed_end);
    sheets.mass.push_back(1.0);
    sheets.pinned.push_back(7);
  }
  // The plate stays flat: its membrane affects nothing but the number of steps that are stable.
  sheets.material.membrane_modulus = std::min(sheets.material.membrane_modulus, body.mount->stiffness);
}

}  // namespace

std::array<std::size_t, 2> Body::axes() const {
  if (axis == 0) return {1, 2};
  return axis == 1 ? std::array<std::size_t, 2>{0, 2} : std::array<std::size_t, 2>{0, 1};
}

std::array<double, 2> Body::divisions() const {
  switch (kind) {
    case BodyKind::plate:
      if (hole > 0.0)  // the longest edges are those beside the corners
        return {8.0 * edges_along(0.25 * std::numbers::pi * lengths[0], edge_length),
                edges_along(std::numbers::sqrt2 / 2.0 * lengths[0] - hole, edge_length)};
      return {edges_along(lengths[0], edge_length), edges_along(lengths[1], edge_length)};
    case BodyKind::disk:
      return {edges_along(mesh::disk_edge * radius, edge_length), 0.0};
    case BodyKind::sphere:
      return {edges_along(mesh::sphere_edge * radius, edge_length), 0.0};
    case BodyKind::cylinder: {
      const double around = edges_along(2.0 * std::numbers::pi * radius, edge_length),
                   ends = std::max(edges_along(mesh::disk_edge * radius, edge_length), 1.0);
      return {has_ends ? ends : std::max(around, 6.0), edges_along(length, edge_length)};
    }
    case BodyKind::cup:
      return {edges_along(mesh::hemisphere_edge * radius, edge_length), 0.0};
    case BodyKind::file:
      break;
  }
  return {};
}

double Body::vertices() const {
  const auto [n, rows] = divisions();
  const double of_disk = 1.0 + 3.0 * n * (n + 1.0);
  switch (kind) {
    case BodyKind::plate:
      return (hole > 0.0 ? n : n + 1.0) * (rows + 1.0);
    case BodyKind::disk:
    case BodyKind::cup:
      return of_disk;
    case BodyKind::sphere:
      return 10.0 * n * n + 2.0;
    case BodyKind::cylinder:
      return has_ends ? 6.0 * n * (rows - 1.0) + 2.0 * of_disk : n * (rows + 1.0);
    case BodyKind::file:
      return static_cast<double>(surface.rest.size());
  }
  return 0.0;
}

double Body::largest_edge() const {
  if (kind != BodyKind::file) return edge_length;
  double largest = 0.0;
  for (const auto& corners : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const mesh::Vector& from = surface.rest[static_cast<std::size_t>(corners[k])];
      const mesh::Vector& to = surface.rest[static_cast<std::size_t>(corners[(k + 1) % 3])];
      largest = std::max(largest, std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
    }
  return largest;
}

double Body::shortened_by(std::size_t along) const {
  const bool is_open_end = kind == BodyKind::cylinder && !has_ends && along == static_cast<std::size_t>(axis);
  return is_open_end ? 0.0 : retraction * spacing[along];
}

std::array<std::array<double, 2>, 3> Body::extents() const {
  const auto along = static_cast<std::size_t>(axis);
  std::array<std::array<double, 2>, 3> result{};
  for (auto& [low, high] : result) low = high = radius;
  if (kind == BodyKind::file) {
    result.fill({-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
    for (const mesh::Vector& x : surface.rest)
      for (std::size_t k = 0; k < 3; ++k)
        result[k] = {std::max(result[k][0], -x[k]), std::max(result[k][1], x[k])};
    return result;
  }
  if (kind == BodyKind::plate) {
    for (std::size_t k = 0; k < 2; ++k) result[axes()[k]] = {0.5 * lengths[k], 0.5 * lengths[k]};
    result[along] = {0.0, 0.0};
  } else if (kind == BodyKind::disk) {
    result[along] = {0.0, 0.0};
  } else if (kind == BodyKind::cylinder) {
    result[along] = {0.5 * length, 0.5 * length};
  } else if (kind == BodyKind::cup) {
    result[along][opens_to_high ? 1 : 0] = 0.0;
  }
  return result;
}

bool Body::moves() const {
  return std::ranges::any_of(motion, [](const std::string& text) { return !text.empty(); });
}

bool Body::slips() const { return slip.value_or(kind == BodyKind::plate || kind == BodyKind::disk); }

std::size_t vertices_of(const std::vector<Body>& bodies) {
  std::size_t sum = 0;
  for (const Body& body : bodies) sum += static_cast<std::size_t>(body.vertices());
  return sum;
}

mesh::Mesh mesh_of(const Body& body) {
  mesh::Mesh mesh = local_mesh(body);
  mesh::Vector scale{1.0, 1.0, 1.0};
  if (body.retraction > 0.0)
    for (std::size_t axis = 0; axis < 3; ++axis)
      scale[axis] -= body.shortened_by(axis) / std::ranges::max(body.extents()[axis]);
  for (mesh::Vector& x : mesh.rest) {
    x = turned(body, x);
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] = body.centre[axis] + scale[axis] * x[axis];
  }
  // The axes x, z along a plate are in the order of a left-handed system with y.
  if (body.kind == BodyKind::plate && body.axis == 1)
    for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  return mesh;
}

fabric::Parameters make_sheets(const std::vector<Body>& bodies) {
  fabric::Parameters sheets;
  for (const Body& body : bodies) {
    const int first = static_cast<int>(sheets.mesh.rest.size());
    const mesh::Mesh mesh = mesh_of(body);
    sheets.mesh.rest.insert(sheets.mesh.rest.end(), mesh.rest.begin(), mesh.rest.end());
    for (std::array<int, 3> corners : mesh.triangles) {
      for (int& corner : corners) corner += first;
      sheets.mesh.triangles.push_back(corners);
    }
    add_motions(body, first, sheets);
  }
  sheets.mass.assign(sheets.mesh.rest.size(), 1.0);  // without effect on pinned vertices
  sheets.pinned.assign(sheets.mesh.rest.size(), 7);
  std::size_t begin = 0;
  for (const Body& body : bodies) {
    if (body.mount) add_springs(body, begin, sheets);
    begin += static_cast<std::size_t>(body.vertices());
  }
  return sheets;
}

void set_offsets(const std::vector<Body>& bodies, std::vector<fabric::Vector>& positions) {
  std::size_t vertex = 0;
  for (const Body& body : bodies) {
    const auto end = vertex + static_cast<std::size_t>(body.vertices());
    for (; vertex < end; ++vertex)
      if (body.mount) positions[vertex][static_cast<std::size_t>(body.axis)] += body.mount->offset;
  }
}

coupling::PorousLaw law_of(const Porosity& p, double density, double viscosity) {
  switch (p.law) {
    case PorosityLaw::none:
      return {0.0, 0.0, true};
    case PorosityLaw::forchheimer:
      return {p.alpha, p.beta, false};
    case PorosityLaw::ergun: {
      const double solid = 1.0 - p.void_fraction, bed = p.thickness / std::pow(p.void_fraction, 3);
      return {150.0 * viscosity * solid * solid * bed / (p.grain * p.grain),
              1.75 * density * solid * bed / p.grain, false};
    }
    case PorosityLaw::kim_peskin:
      return {1.0 / (p.pores * p.conductance), 0.0, false};
  }
  return {};
}

}  // namespace drogue::parachute_app
