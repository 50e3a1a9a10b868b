#include "miniapps/parachute/canopy/canopy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <span>

#include "kernels/fabric/elastic/elongation.hpp"
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

/// Distances of the rings from the apex along a meridian, m, from the vent to the skirt. One of them is the
/// edge of the flat cloth.
std::vector<double> ring_distances(const Canopy& canopy) {
  const double inner = 0.5 * canopy.vent, outer = 0.5 * canopy.diameter;
  const int bands = quotient_up(outer - inner, canopy.edge_length);
  std::vector<double> distances;
  for (int k = inner > 0.0 ? 0 : 1; k < bands; ++k) distances.push_back(inner + (outer - inner) * k / bands);
  distances.push_back(outer);
  if (!canopy.has_skirt()) return distances;
  const int more = quotient_up(canopy.skirt.length, canopy.edge_length);
  for (int k = 1; k <= more; ++k) distances.push_back(outer + canopy.skirt.length * k / more);
  return distances;
}

/// Distance of a point of a meridian from the axis at rest, m.
double radius_at(const Canopy& canopy, double distance) {
  const double flat = 0.5 * canopy.diameter;
  if (distance <= flat) return distance;
  return flat + (distance - flat) / canopy.skirt.length * (canopy.skirt_radius() - flat);
}

/// Places of vertices in the cloth: distance from the apex along a meridian, m, and angle as a fraction of
/// the circle.
struct PolarPoint {
  double distance = 0.0, turn = 0.0;
};

/// Rings of vertices and the triangles between them.
struct RingMesh {
  std::vector<PolarPoint> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> ring_begin;  ///< first vertex of each ring
  std::vector<int> ring_size;
  std::vector<std::size_t> triangles_inside;  ///< number of triangles inside of each ring, which come first
};

/// Triangles between two rings that share `sectors` aligned vertices, whose edges become edges of the mesh.
/// In each sector the triangle with the shorter new edge comes next; equal ones alternate.
void join_rings(RingMesh& cloth, std::size_t inner) {
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

RingMesh make_rings(const Canopy& canopy) {
  RingMesh cloth;
  if (canopy.vent == 0.0) cloth.points.push_back({});
  const std::vector<double> distances = ring_distances(canopy);
  cloth.ring_size = ring_sizes(canopy);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    cloth.ring_begin.push_back(static_cast<int>(cloth.points.size()));
    for (int i = 0; i < cloth.ring_size[k]; ++i)
      cloth.points.push_back({distances[k], static_cast<double>(i) / cloth.ring_size[k]});
  }
  if (canopy.vent == 0.0)
    for (int i = 0; i < cloth.ring_size[0]; ++i)
      cloth.triangles.push_back({0, 1 + i, 1 + (i + 1) % cloth.ring_size[0]});
  cloth.triangles_inside.push_back(cloth.triangles.size());
  for (std::size_t k = 0; k + 1 < distances.size(); ++k) {
    join_rings(cloth, k);
    cloth.triangles_inside.push_back(cloth.triangles.size());
  }
  return cloth;
}

/// Bands along edges: the skirt, the vent, and each seam as far as the rings have a vertex for it.
void add_reinforcement(const Canopy& canopy, const RingMesh& cloth, fabric::Mesh& mesh) {
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
    const int seams = std::min(inner, canopy.gores);
    if (canopy.gores % seams != 0 || outer % seams != 0) continue;  // its vertices lie beside the seams
    for (int seam = 0; seam < seams; ++seam) {
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
  const double azimuth = canopy.azimuth * pi / 180.0, u = std::cos(azimuth), v = std::sin(azimuth);
  return {{c * u, c * v, -s}, {-v, u, 0.0}, {s * u, s * v, c}};
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
/// apex and a shift, m, towards the skirt. Without it, lengths within a pleat are those of the flat cloth.
Vector pleated_place(const Canopy& canopy, const CanopyAxes& axes, const PolarPoint& at, double shift) {
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
  if (at.distance == 0.0) return axes.place(canopy.centre, 0.0, 0.0, apex - shift);
  const double distance = at.distance + shift;
  return axes.place(canopy.centre, distance * (l * left[0] + r * right[0]),
                    distance * (l * left[1] + r * right[1]), apex + distance * (l * left[2] + r * right[2]));
}

/// Least number from `low` to `high` at which a convex function is smallest, where values up to round-off
/// count as 0.
template <class Function>
double least_minimum(double low, double high, const Function& function) {
  constexpr double round_off = 1e-9;
  constexpr int steps = 60;
  const auto value = [&](double at) {
    const double exact = function(at);
    return exact <= round_off ? 0.0 : exact;
  };
  if (value(low) == 0.0) return low;
  for (int k = 0; k < steps; ++k) {
    const double third = (high - low) / 3.0;
    if (value(low + third) <= value(high - third))
      high -= third;
    else
      low += third;
  }
  return high;
}

/// Lays the cloth as a pleated cone. A triangle that spans a fold, where the mesh is coarser than the pleats,
/// has a shorter base than at rest and would be stretched across it: what is inside of it lies nearer to the
/// skirt by as much. Elongation is a convex function of the shift, since places are linear ones.
void lay_pleats(const Canopy& canopy, const CanopyAxes& axes, const RingMesh& cloth, CanopyMesh& to) {
  const std::size_t rings = cloth.ring_size.size();
  const auto lay = [&](std::size_t begin, std::size_t count, double shift) {
    for (std::size_t i = begin; i < begin + count; ++i)
      to.positions[i] = pleated_place(canopy, axes, cloth.points[i], shift);
  };
  double shift = 0.0, outside = 0.5 * canopy.diameter;
  for (std::size_t ring = rings; ring-- > 0;) {
    const auto begin = static_cast<std::size_t>(cloth.ring_begin[ring]),
               count = static_cast<std::size_t>(cloth.ring_size[ring]);
    const double distance = cloth.points[begin].distance;
    if (ring + 1 < rings) {
      const std::size_t first = cloth.triangles_inside[ring];
      const std::span band(cloth.triangles.data() + first, cloth.triangles_inside[ring + 1] - first);
      shift = least_minimum(shift, shift + 0.9 * (outside - distance), [&](double by) {
        lay(begin, count, by);
        return fabric::largest_elongation(to.fabric.mesh, band, to.positions);
      });
    }
    lay(begin, count, shift);
    outside = distance;
  }
  if (canopy.vent > 0.0) return;
  const std::span fan(cloth.triangles.data(), cloth.triangles_inside[0]);
  shift = least_minimum(shift, shift + 0.9 * outside, [&](double by) {
    lay(0, 1, by);
    return fabric::largest_elongation(to.fabric.mesh, fan, to.positions);
  });
  lay(0, 1, shift);
}

/// Place of a vertex in the cloth as constructed.
Vector constructed_place(const Canopy& canopy, const CanopyAxes& axes, const PolarPoint& at) {
  const double angle = 2.0 * pi * at.turn, radius = radius_at(canopy, at.distance);
  const double below = at.distance - 0.5 * canopy.diameter;  // the edge of the flat cloth, along the skirt
  const double height = canopy.skirt_height() * (below > 0.0 ? 1.0 - below / canopy.skirt.length : 1.0);
  return axes.place(canopy.centre, radius * std::cos(angle), radius * std::sin(angle), height);
}

/// Distance of the point where the lines meet from the plane of a skirt, m, with lines at their length.
double meeting_distance(const Canopy& canopy, double skirt_radius) {
  return std::sqrt(std::max(0.0, canopy.lines.length * canopy.lines.length - skirt_radius * skirt_radius));
}

/// Place of the payload below a skirt of a radius, m, with lines and riser at their lengths.
Vector payload_place(const Canopy& canopy, double skirt_radius) {
  const double riser = canopy.riser ? canopy.riser->length : 0.0;
  return axes_of(canopy).place(canopy.centre, 0.0, 0.0, -meeting_distance(canopy, skirt_radius) - riser);
}

/// Springs between neighbouring vertices of the skirt that have lines.
void add_reefing(const Canopy& canopy, CanopyMesh& to) {
  fabric::Mesh& mesh = to.fabric.mesh;
  mesh.line_length.resize(mesh.lines.size(), 0.0);
  if (!canopy.reefing) return;
  for (std::size_t k = 0; k < to.skirt.size(); ++k) {
    to.reefing.push_back(static_cast<int>(mesh.lines.size()));
    mesh.lines.push_back({to.skirt[k], to.skirt[(k + 1) % to.skirt.size()]});
    mesh.line_stiffness.push_back(canopy.reefing->stiffness);
    mesh.line_length.push_back(canopy.reefing->length / canopy.gores);
  }
}

/// Gives a drum its tension, by a smaller mesh at rest, and its deflection in the first axisymmetric mode.
void stretch_drum(const Canopy& canopy, const CanopyAxes& axes, const RingMesh& cloth, CanopyMesh& to) {
  constexpr double first_zero = 2.404825557695773;  // of the Bessel function J0
  for (std::size_t i = 0; i < cloth.points.size(); ++i) {
    const double height =
        canopy.deflection *
        std::cyl_bessel_j(0.0, first_zero * 2.0 * cloth.points[i].distance / canopy.diameter);
    to.positions[i] = axes.place(to.positions[i], 0.0, 0.0, height);
    Vector& rest = to.fabric.mesh.rest[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      rest[axis] = canopy.centre[axis] + (rest[axis] - canopy.centre[axis]) / canopy.stretch();
  }
}

/// Vent lines as springs from the seams at the edge of the vent to the place where they cross. Where the edge
/// has fewer vertices than the canopy has gores, each spring stands for the lines of several seams.
void add_vent_lines(const Canopy& canopy, const CanopyAxes& axes, const RingMesh& cloth, CanopyMesh& to) {
  if (!canopy.vent_lines) return;
  fabric::Parameters& p = to.fabric;
  const int vertices = cloth.ring_size.front(), per_seam = std::max(1, vertices / canopy.gores);
  std::vector<int> seams;
  for (int k = 0; k < vertices; k += per_seam) seams.push_back(cloth.ring_begin.front() + k);
  const auto ends = static_cast<double>(seams.size());
  const double mass = 0.5 * canopy.vent_lines->line_density * canopy.gores * 0.5 * canopy.vent;
  Vector centre{};
  for (const int i : seams) {
    p.mass[static_cast<std::size_t>(i)] += mass / ends;
    for (std::size_t axis = 0; axis < 3; ++axis)
      centre[axis] += to.positions[static_cast<std::size_t>(i)][axis] / ends;
  }
  const auto first = static_cast<int>(p.mesh.lines.size());
  for (std::size_t k = 0; k < seams.size(); ++k) to.vent_lines.push_back(first + static_cast<int>(k));
  fabric::add_payload(p,
                      {constructed_place(canopy, axes, PolarPoint{}), mass,
                       canopy.vent_lines->stiffness * canopy.gores / ends},
                      seams);
  to.positions.push_back(centre);
}

/// Suspension lines, the riser and the payload, unless it is shared.
void add_lines(const Canopy& canopy, const CanopyAxes& axes, CanopyMesh& to) {
  fabric::Parameters& p = to.fabric;
  const double half_line = 0.5 * canopy.lines.length * canopy.lines.line_density;
  for (const int i : to.skirt) p.mass[static_cast<std::size_t>(i)] += half_line;
  const double at_rest = canopy.skirt_radius(), at_start = canopy.starting_skirt_radius();
  const auto meeting_place = [&](double radius) {
    return axes.place(canopy.centre, 0.0, 0.0, -meeting_distance(canopy, radius));
  };
  const auto first = static_cast<int>(p.mesh.lines.size());
  for (int k = 0; k < canopy.gores; ++k) to.suspension.push_back(first + k);
  const double mass = canopy.riser ? canopy.riser->mass : canopy.payload.mass;
  const int meeting = fabric::add_payload(
      p, {meeting_place(at_rest), mass + half_line * canopy.gores, canopy.lines.stiffness}, to.skirt);
  to.positions.push_back(meeting_place(at_start));
  if (!canopy.riser || canopy.payload.shared) return;
  to.riser = static_cast<int>(p.mesh.lines.size());
  fabric::add_payload(p, {payload_place(canopy, at_rest), canopy.payload.mass, canopy.riser->stiffness},
                      std::array{meeting});
  to.positions.push_back(payload_place(canopy, at_start));
}

/// Displaces the cloth along its axis by numbers that are uniformly distributed within the amplitude.
void perturb(const Canopy& canopy, const CanopyAxes& axes, std::vector<Vector>& positions) {
  if (canopy.perturbation.amplitude == 0.0) return;
  std::mt19937 engine(static_cast<std::uint32_t>(canopy.perturbation.seed));
  constexpr double scale = 2.0 / std::mt19937::max();
  for (Vector& x : positions)
    x = axes.place(x, 0.0, 0.0,
                   canopy.perturbation.amplitude * (scale * static_cast<double>(engine()) - 1.0));
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

/// The Cauchy stress of equal stretches l along two axes is E (l^2 - 1) / (2 (1 - nu)) for St
/// Venant-Kirchhoff membranes with the membrane modulus E.
double Canopy::stretch() const {
  if (kind != CanopyKind::drum) return 1.0;
  return std::sqrt(1.0 + 2.0 * tension * (1.0 - poisson) / membrane_modulus);
}

double Canopy::skirt_radius() const { return 0.5 * (has_skirt() ? skirt.diameter : diameter); }

double Canopy::skirt_height() const {
  if (!has_skirt()) return 0.0;
  const double inwards = 0.5 * diameter - skirt_radius();
  return std::sqrt(std::max(0.0, skirt.length * skirt.length - inwards * inwards));
}

double Canopy::nominal_area() const {
  const double flat = 0.25 * pi * diameter * diameter;
  if (!has_skirt()) return flat;
  return flat + pi * (0.5 * diameter + skirt_radius()) * skirt.length;
}

double Canopy::nominal_diameter() const { return std::sqrt(4.0 / pi * nominal_area()); }

double Canopy::starting_skirt_radius() const {
  return shape == CanopyShape::partly_closed ? closure * skirt_radius() : skirt_radius();
}

std::size_t Canopy::vertices() const {
  const std::vector<int> sizes = ring_sizes(*this);
  const int ends = (riser ? 1 : 0) + (payload.shared ? 0 : 1);
  const int others = (vent == 0.0 ? 1 : 0) + (vent_lines ? 1 : 0) + (has_lines() ? ends : 0);
  return static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), others));
}

const char* CanopyRows::part_of(std::size_t vertex) const {
  if (vertex < cloth_end) return "cloth";
  if (vertex == vent_crossing) return "vent lines";
  return vertex == payload ? "payload" : "riser";
}

std::vector<int> ring_sizes(const Canopy& canopy) {
  const std::vector<double> distances = ring_distances(canopy);
  std::vector<int> sizes(distances.size());
  int divided = canopy.gores;
  for (std::size_t k = distances.size(); k-- > 0;) {
    const int least = quotient_up(2.0 * pi * radius_at(canopy, distances[k]), canopy.edge_length);
    const int per_gore = quotient_up(least, canopy.gores);
    // An even number of edges has a vertex in the middle of the gore, where a pleat folds.
    sizes[k] = canopy.gores * (per_gore == 1 ? 1 : per_gore + per_gore % 2);
    // Every line needs a vertex of the skirt; seams run through a conical skirt.
    if (k + 1 == distances.size() || distances[k] >= 0.5 * canopy.diameter) continue;
    // Near the vent, not every seam has a vertex: from ring to ring inwards, their number is divided.
    const int fewest = std::max(least, 3);
    for (int fewer = divided; fewer >= fewest; --fewer)
      if (divided % fewer == 0) sizes[k] = fewer;
    // Without a divisor near it, such as for a prime number of gores, no seam has a vertex.
    if (sizes[k] > 3 * fewest) sizes[k] = fewest;
    divided = std::min(divided, sizes[k]);
  }
  return sizes;
}

CanopyMesh make_canopy(const Canopy& canopy) {
  CanopyMesh result;
  const RingMesh cloth = make_rings(canopy);
  const CanopyAxes axes = axes_of(canopy);
  fabric::Parameters& p = result.fabric;
  for (const PolarPoint& at : cloth.points) p.mesh.rest.push_back(constructed_place(canopy, axes, at));
  p.mesh.triangles = cloth.triangles;
  result.positions = p.mesh.rest;
  if (canopy.shape == CanopyShape::partly_closed) lay_pleats(canopy, axes, cloth, result);
  perturb(canopy, axes, result.positions);
  result.cloth_vertices = cloth.points.size();
  p.mass = fabric::lumped_masses(p.mesh, canopy.area_density, 0.0, fabric::Lumping::area);
  if (canopy.kind == CanopyKind::drum) stretch_drum(canopy, axes, cloth, result);
  add_reinforcement(canopy, cloth, p.mesh);
  add_vent_lines(canopy, axes, cloth, result);
  const int skirt_begin = cloth.ring_begin.back(), per_gore = cloth.ring_size.back() / canopy.gores;
  for (int gore = 0; gore < canopy.gores; ++gore) result.skirt.push_back(skirt_begin + gore * per_gore);
  add_reefing(canopy, result);
  if (canopy.has_lines()) add_lines(canopy, axes, result);
  p.pinned.assign(p.mesh.rest.size(), 0);
  if (canopy.kind == CanopyKind::drum)
    std::fill(p.pinned.begin() + skirt_begin, p.pinned.end(), std::uint8_t{7});
  if (canopy.has_lines() && !canopy.payload.shared)
    p.pinned.back() = canopy.payload.fixed ? 7 : canopy.payload.guided ? 3 : 0;
  return result;
}

Vector payload_place(const Canopy& canopy) { return payload_place(canopy, canopy.starting_skirt_radius()); }

void place_at_shared_payloads(std::vector<Canopy>& canopies) {
  for (Canopy& canopy : canopies) {
    if (!canopy.payload.shared || !canopy.riser) continue;
    const Canopy& owner = canopies[static_cast<std::size_t>(*canopy.payload.shared)];
    canopy.centre = axes_of(canopy).place(
        payload_place(owner), 0.0, 0.0,
        canopy.riser->length + meeting_distance(canopy, canopy.starting_skirt_radius()));
  }
}

namespace {

/// Line from the point where the lines of a canopy meet to the payload of an earlier one.
int add_shared_riser(const Riser& riser, std::size_t meeting, std::size_t payload, fabric::Mesh& mesh) {
  mesh.lines.push_back({static_cast<int>(meeting), static_cast<int>(payload)});
  mesh.line_stiffness.push_back(riser.stiffness);
  mesh.line_length.push_back(riser.length);
  return static_cast<int>(mesh.lines.size()) - 1;
}

void append_canopy(const Canopy& canopy, const coupling::PorousLaw& law, Sheets& sheets) {
  fabric::Parameters& p = sheets.fabric;
  const CanopyMesh one = make_canopy(canopy);
  const int begin = static_cast<int>(p.mesh.rest.size()), line = static_cast<int>(p.mesh.lines.size());
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  CanopyRows rows;
  rows.begin = p.mesh.rest.size();
  rows.cloth_end = rows.begin + one.cloth_vertices;
  rows.triangles_begin = p.mesh.triangles.size();
  append(p.mesh.rest, one.fabric.mesh.rest);
  append(p.mass, one.fabric.mass);
  append(p.pinned, one.fabric.pinned);
  append(p.mesh.line_stiffness, one.fabric.mesh.line_stiffness);
  append(p.mesh.line_length, one.fabric.mesh.line_length);
  append(sheets.positions, one.positions);
  for (const std::uint8_t fixed_axes : one.fabric.pinned) {
    Vector& velocity = sheets.velocities.emplace_back(canopy.start_velocity);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((fixed_axes >> axis & 1U) != 0U) velocity[axis] = 0.0;
  }
  for (const auto& t : one.fabric.mesh.triangles)
    p.mesh.triangles.push_back({t[0] + begin, t[1] + begin, t[2] + begin});
  for (const auto& ends : one.fabric.mesh.lines) p.mesh.lines.push_back({ends[0] + begin, ends[1] + begin});
  p.mesh.line_length.resize(p.mesh.lines.size(), 0.0);
  rows.end = p.mesh.rest.size();
  rows.triangles_end = p.mesh.triangles.size();
  for (const int k : one.reefing) rows.reefing.push_back(line + k);
  for (const int k : one.suspension) rows.suspension.push_back(line + k);
  if (one.riser) rows.riser = line + *one.riser;
  if (canopy.vent_lines) rows.vent_crossing = rows.cloth_end;
  if (canopy.has_lines()) rows.payload = rows.end - 1;
  if (canopy.payload.shared && canopy.riser) {
    rows.payload = sheets.canopies[static_cast<std::size_t>(*canopy.payload.shared)].payload;
    rows.riser = add_shared_riser(*canopy.riser, rows.end - 1, rows.payload.value(), p.mesh);
  }
  sheets.line_strength.resize(p.mesh.lines.size(), std::numeric_limits<double>::infinity());
  if (canopy.lines.strength)
    for (const int k : rows.suspension)
      sheets.line_strength[static_cast<std::size_t>(k)] = *canopy.lines.strength;
  rows.line_drag = sheets.line_drag.size();
  rows.payload_drag = sheets.vertex_drag.size();
  if (const auto& drag = canopy.lines.drag)
    for (const int k : rows.suspension)
      sheets.line_drag.push_back({k, drag->coefficient * drag->diameter, drag->friction * drag->diameter});
  if (const auto& drag = canopy.payload.drag)
    sheets.vertex_drag.push_back({static_cast<int>(rows.payload.value()), drag->coefficient * drag->area});
  if (canopy.reefing && canopy.reefing->cut) sheets.cuts.push_back({*canopy.reefing->cut, rows.reefing});
  if (canopy.payload.release)
    sheets.cuts.push_back({*canopy.payload.release, rows.riser ? std::vector{*rows.riser} : rows.suspension});
  sheets.laws.insert(sheets.laws.end(), one.positions.size(), law);
  sheets.canopies.push_back(rows);
  p.material.membrane_modulus = canopy.membrane_modulus;
  p.material.poisson = canopy.poisson;
  p.material.tension_only = true;
}

}  // namespace

Sheets make_all_sheets(const std::vector<Body>& bodies, const std::vector<Canopy>& canopies, double density,
                       double viscosity, const std::vector<Flag>& flags) {
  Sheets sheets;
  sheets.fabric = make_sheets(bodies);
  fabric::Parameters& p = sheets.fabric;
  sheets.positions = p.mesh.rest;
  for (const Body& body : bodies) {
    coupling::PorousLaw law = law_of(body.porosity, density, viscosity);
    law.no_slip = !body.slips();
    sheets.laws.insert(sheets.laws.end(), static_cast<std::size_t>(body.vertices()), law);
  }
  sheets.laws.resize(sheets.positions.size());  // fixed ends of springs have no area
  set_offsets(bodies, sheets.positions);
  sheets.velocities.resize(sheets.positions.size());
  for (const Canopy& canopy : canopies)
    append_canopy(canopy, law_of(canopy.porosity, density, viscosity), sheets);
  sheets.flags = append_flags(flags, p, sheets.positions);
  sheets.velocities.resize(sheets.positions.size());
  coupling::PorousLaw of_flags;
  of_flags.impermeable = of_flags.no_slip = true;
  sheets.laws.resize(sheets.positions.size(), of_flags);
  return sheets;
}

}  // namespace drogue::parachute_app
