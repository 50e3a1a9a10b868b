#include "miniapps/parachute/canopy/canopy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/fabric/payload.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using std::numbers::pi;

/// Ratio of a length to another one, rounded up; round-off of an integer quotient must not add one.
int quotient_up(double length, double part) {
  return std::max(1, static_cast<int>(std::ceil(length / part * (1.0 - 1e-9))));
}

/// Radii of the rings from the vent to the skirt, m.
std::vector<double> ring_radii(const Canopy& canopy) {
  const double inner = 0.5 * canopy.vent, outer = 0.5 * canopy.diameter;
  const int bands = quotient_up(outer - inner, canopy.edge_length);
  std::vector<double> radii;
  for (int k = inner > 0.0 ? 0 : 1; k < bands; ++k) radii.push_back(inner + (outer - inner) * k / bands);
  radii.push_back(outer);
  return radii;
}

/// Places of vertices in the flat cloth: radius, m, and angle as a fraction of the circle.
struct PolarPoint {
  double radius = 0.0, turn = 0.0;
};

/// Rings of vertices and the triangles between them.
struct FlatCloth {
  std::vector<PolarPoint> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> ring_begin;  ///< first vertex of each ring
  std::vector<int> ring_size;
};

/// Triangles between two rings that share `sectors` aligned vertices, whose edges become edges of the mesh.
/// In each sector the triangle with the shorter new edge comes next; equal ones alternate.
void join_rings(FlatCloth& cloth, std::size_t inner) {
  const int a0 = cloth.ring_begin[inner], na = cloth.ring_size[inner];
  const int b0 = cloth.ring_begin[inner + 1], nb = cloth.ring_size[inner + 1];
  const int sectors = std::gcd(na, nb), per_a = na / sectors, per_b = nb / sectors;
  for (int s = 0; s < sectors; ++s) {
    int i = 0, j = 0;
    const auto a = [&](int k) { return a0 + (s * per_a + k) % na; };
    const auto b = [&](int k) { return b0 + (s * per_b + k) % nb; };
    while (i < per_a || j < per_b) {
      // Angles that the new edges span, in a common unit.
      const int by_outer = std::abs(i * per_b - (j + 1) * per_a),
                by_inner = std::abs((i + 1) * per_b - j * per_a);
      const bool first_diagonal = (s * per_a + i + static_cast<int>(inner)) % 2 == 0;
      const bool outer =
          i == per_a || (j < per_b && (by_outer < by_inner || (by_outer == by_inner && first_diagonal)));
      if (outer) {
        cloth.triangles.push_back({a(i), b(j), b(j + 1)});
        ++j;
      } else {
        cloth.triangles.push_back({a(i), b(j), a(i + 1)});
        ++i;
      }
    }
  }
}

FlatCloth make_flat_cloth(const Canopy& canopy) {
  FlatCloth cloth;
  if (canopy.vent == 0.0) cloth.points.push_back({});
  const std::vector<double> radii = ring_radii(canopy);
  cloth.ring_size = ring_sizes(canopy);
  for (std::size_t k = 0; k < radii.size(); ++k) {
    cloth.ring_begin.push_back(static_cast<int>(cloth.points.size()));
    for (int i = 0; i < cloth.ring_size[k]; ++i)
      cloth.points.push_back({radii[k], static_cast<double>(i) / cloth.ring_size[k]});
  }
  if (canopy.vent == 0.0)
    for (int i = 0; i < cloth.ring_size[0]; ++i)
      cloth.triangles.push_back({0, 1 + i, 1 + (i + 1) % cloth.ring_size[0]});
  for (std::size_t k = 0; k + 1 < radii.size(); ++k) join_rings(cloth, k);
  return cloth;
}

/// Bands along edges: the skirt, the vent, and each seam as far as the rings have a vertex for it.
void add_reinforcement(const Canopy& canopy, const FlatCloth& cloth, fabric::Mesh& mesh) {
  const auto add = [&](int a, int b, double stiffness) {
    mesh.lines.push_back({a, b});
    mesh.line_stiffness.push_back(stiffness);
  };
  const auto add_ring = [&](std::size_t ring, double stiffness) {
    const int n = cloth.ring_size[ring], begin = cloth.ring_begin[ring];
    for (int i = 0; i < n; ++i) add(begin + i, begin + (i + 1) % n, stiffness);
  };
  if (canopy.reinforcement.skirt > 0.0) add_ring(cloth.ring_begin.size() - 1, canopy.reinforcement.skirt);
  if (canopy.reinforcement.vent > 0.0) add_ring(0, canopy.reinforcement.vent);
  if (!(canopy.reinforcement.seams > 0.0)) return;
  for (std::size_t ring = 0; ring + 1 < cloth.ring_begin.size(); ++ring) {
    const int inner = cloth.ring_size[ring], outer = cloth.ring_size[ring + 1];
    for (int seam = 0; seam < std::min(inner, canopy.gores); ++seam) {
      const int seams = std::min(inner, canopy.gores);
      add(cloth.ring_begin[ring] + seam * (inner / seams),
          cloth.ring_begin[ring + 1] + seam * (outer / seams), canopy.reinforcement.seams);
    }
  }
}

/// The axis of a canopy, and a right-handed pair normal to it.
struct CanopyAxes {
  Vector first, second, axis;

  [[nodiscard]] Vector place(const Vector& origin, double u, double v, double along) const {
    Vector x = origin;
    for (std::size_t k = 0; k < 3; ++k) x[k] += u * first[k] + v * second[k] + along * axis[k];
    return x;
  }
};

CanopyAxes axes_of(const Canopy& canopy) {
  const double angle = canopy.axis_angle() * pi / 180.0, c = std::cos(angle), s = std::sin(angle);
  return {{c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c}};
}

/// Polar angles from the axis of the rays of a pleated cone: the seams, and the folds halfway between them.
/// Neighbouring rays enclose the angle of the flat cloth, pi / gores, so that the cone is isometric to it.
std::array<double, 2> ray_angles(const Canopy& canopy) {
  const double between = pi / canopy.gores, seam = std::asin(canopy.closure);
  // cos(between) = cos(seam) cos(fold) + sin(seam) sin(fold) cos(between)
  const double a = std::cos(seam), b = std::sin(seam) * std::cos(between);
  return {seam, std::atan2(b, a) - std::acos(std::min(1.0, std::cos(between) / std::hypot(a, b)))};
}

/// Place of a vertex on a pleated cone: on the plane between its neighbouring rays, at its distance from the
/// apex. Lengths within a pleat are those of the flat cloth.
Vector pleated_place(const Canopy& canopy, const CanopyAxes& axes, const PolarPoint& at) {
  const auto angles = ray_angles(canopy);
  const double between = pi / canopy.gores, turn = at.turn * 2.0 * canopy.gores;
  const double ray = std::floor(turn + 1e-9), part = std::max(0.0, turn - ray);
  const auto direction = [&](double number) {
    const double polar = angles[static_cast<std::size_t>(std::fmod(number, 2.0))], azimuth = number * between;
    return Vector{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), -std::cos(polar)};
  };
  const Vector left = direction(ray), right = direction(ray + 1.0);
  // The unit vector between them at the fraction `part` of their angle.
  const double l = std::sin((1.0 - part) * between) / std::sin(between),
               r = std::sin(part * between) / std::sin(between);
  const double apex = 0.5 * canopy.diameter * std::cos(angles[0]);  // above the skirt
  return axes.place(canopy.centre, at.radius * (l * left[0] + r * right[0]),
                    at.radius * (l * left[1] + r * right[1]),
                    apex + at.radius * (l * left[2] + r * right[2]));
}

Vector flat_place(const Canopy& canopy, const CanopyAxes& axes, const PolarPoint& at) {
  const double angle = 2.0 * pi * at.turn;
  return axes.place(canopy.centre, at.radius * std::cos(angle), at.radius * std::sin(angle), 0.0);
}

/// Distance of the payload from the plane of a skirt, m, with lines at their length.
double payload_distance(const Canopy& canopy, double skirt_radius) {
  return std::sqrt(std::max(0.0, canopy.lines.length * canopy.lines.length - skirt_radius * skirt_radius));
}

}  // namespace

double Canopy::axis_angle() const {
  switch (shape) {
    case CanopyShape::angled_15:
      return 15.0;
    case CanopyShape::angled_60:
      return 60.0;
    case CanopyShape::angled_75:
      return 75.0;
    default:
      return angle;
  }
}

double Canopy::nominal_area() const { return 0.25 * pi * diameter * diameter; }

std::size_t Canopy::vertices() const {
  const std::vector<int> sizes = ring_sizes(*this);
  return static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), vent == 0.0 ? 2 : 1));
}

std::vector<int> ring_sizes(const Canopy& canopy) {
  const std::vector<double> radii = ring_radii(canopy);
  std::vector<int> sizes(radii.size());
  int divided = canopy.gores;
  for (std::size_t k = radii.size(); k-- > 0;) {
    const int least = quotient_up(2.0 * pi * radii[k], canopy.edge_length);
    const int per_gore = quotient_up(least, canopy.gores);
    // An even number of edges has a vertex in the middle of the gore, where a pleat folds.
    sizes[k] = canopy.gores * (per_gore == 1 ? 1 : per_gore + per_gore % 2);
    if (k + 1 == radii.size()) continue;  // every line needs a vertex of the skirt
    // Near the vent, not every seam has a vertex: from ring to ring inwards, their number is divided.
    for (int fewer = divided; fewer >= std::max(least, 3); --fewer)
      if (divided % fewer == 0) sizes[k] = fewer;
    divided = std::min(divided, sizes[k]);
  }
  return sizes;
}

CanopyMesh make_canopy(const Canopy& canopy) {
  CanopyMesh result;
  const FlatCloth cloth = make_flat_cloth(canopy);
  const CanopyAxes axes = axes_of(canopy);
  const bool is_pleated = canopy.shape == CanopyShape::partly_closed;
  fabric::Parameters& p = result.fabric;
  for (const PolarPoint& at : cloth.points) {
    p.mesh.rest.push_back(flat_place(canopy, axes, at));
    result.positions.push_back(is_pleated ? pleated_place(canopy, axes, at) : p.mesh.rest.back());
  }
  p.mesh.triangles = cloth.triangles;
  result.cloth_vertices = cloth.points.size();
  p.mass = fabric::lumped_masses(p.mesh, canopy.area_density, 0.0, fabric::Lumping::area);
  add_reinforcement(canopy, cloth, p.mesh);
  const int skirt_begin = cloth.ring_begin.back(), per_gore = cloth.ring_size.back() / canopy.gores;
  for (int gore = 0; gore < canopy.gores; ++gore) result.skirt.push_back(skirt_begin + gore * per_gore);
  const double half_line = 0.5 * canopy.lines.length * canopy.lines.line_density;
  for (const int i : result.skirt) p.mass[static_cast<std::size_t>(i)] += half_line;
  const double radius = 0.5 * canopy.diameter;
  const Vector rest = axes.place(canopy.centre, 0.0, 0.0, -payload_distance(canopy, radius));
  fabric::add_payload(p, {rest, canopy.payload.mass + half_line * canopy.gores, canopy.lines.stiffness},
                      result.skirt);
  const double skirt_radius = is_pleated ? radius * canopy.closure : radius;
  result.positions.push_back(axes.place(canopy.centre, 0.0, 0.0, -payload_distance(canopy, skirt_radius)));
  p.pinned.assign(p.mesh.rest.size(), 0);
  if (canopy.payload.fixed) p.pinned.back() = 7;
  return result;
}

Sheets make_all_sheets(const std::vector<Body>& bodies, const std::vector<Canopy>& canopies, double density,
                       double viscosity) {
  Sheets sheets;
  sheets.fabric = make_sheets(bodies);
  fabric::Parameters& p = sheets.fabric;
  sheets.positions = p.mesh.rest;
  for (const Body& body : bodies) {
    coupling::PorousLaw law = law_of(body.porosity, density, viscosity);
    law.no_slip = !body.slips();
    sheets.laws.insert(sheets.laws.end(), static_cast<std::size_t>(body.vertices()), law);
  }
  for (const Canopy& canopy : canopies) {
    const CanopyMesh one = make_canopy(canopy);
    const int begin = static_cast<int>(p.mesh.rest.size());
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    CanopyRows rows{p.mesh.rest.size(), p.mesh.rest.size() + one.cloth_vertices, p.mesh.triangles.size(), 0};
    append(p.mesh.rest, one.fabric.mesh.rest);
    append(p.mass, one.fabric.mass);
    append(p.pinned, one.fabric.pinned);
    append(p.mesh.line_stiffness, one.fabric.mesh.line_stiffness);
    append(sheets.positions, one.positions);
    for (const auto& t : one.fabric.mesh.triangles)
      p.mesh.triangles.push_back({t[0] + begin, t[1] + begin, t[2] + begin});
    for (const auto& line : one.fabric.mesh.lines) p.mesh.lines.push_back({line[0] + begin, line[1] + begin});
    rows.triangles_end = p.mesh.triangles.size();
    sheets.laws.insert(sheets.laws.end(), one.positions.size(), law_of(canopy.porosity, density, viscosity));
    sheets.canopies.push_back(rows);
    p.material.membrane_modulus = canopy.membrane_modulus;
    p.material.poisson = canopy.poisson;
    p.material.tension_only = true;
  }
  return sheets;
}

}  // namespace drogue::parachute_app
