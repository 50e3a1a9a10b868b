#include "miniapps/parachute/canopy/canopy_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "kernels/mesh/edges.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

constexpr int raster_squares = 256;  // along the larger extent

double squared_distance(const Vector& a, const Vector& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/// Force of a line without compression on its second end, N.
Vector pull_of_line(const fabric::Mesh& mesh, std::size_t line, std::span<const Vector> positions) {
  const Vector &a = positions[static_cast<std::size_t>(mesh.lines[line][0])],
               &b = positions[static_cast<std::size_t>(mesh.lines[line][1])];
  const double length = std::sqrt(squared_distance(a, b)), rest = mesh::rest_length(mesh, line);
  const double tension = std::max(0.0, mesh.line_stiffness[line] * (length / rest - 1.0));
  Vector pull{};
  for (std::size_t axis = 0; axis < 3; ++axis) pull[axis] = tension * (a[axis] - b[axis]) / length;
  return pull;
}

/// Vertices of a suspension line.
struct LineEnds {
  std::size_t skirt, meeting;
};
LineEnds ends_of(const CanopyRows& rows, const fabric::Mesh& mesh, int line) {
  const auto [a, b] = mesh.lines[static_cast<std::size_t>(line)];
  const auto one = static_cast<std::size_t>(a), other = static_cast<std::size_t>(b);
  return one < rows.cloth_end ? LineEnds{one, other} : LineEnds{other, one};
}

/// Mean of vectors of the cloth with the weights of its masses, kg.
Vector mean_over_mass(const CanopyRows& rows, const std::vector<double>& masses,
                      const std::vector<Vector>& vectors) {
  Vector sum{};
  double mass = 0.0;
  for (std::size_t i = rows.begin; i < rows.cloth_end; ++i) {
    mass += masses[i];
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += masses[i] * vectors[i][axis];
  }
  for (double& component : sum) component /= mass;
  return sum;
}

/// Doubled area vector of a triangle, m^2.
Vector doubled_area_vector(const std::array<int, 3>& triangle, std::span<const Vector> positions) {
  const auto at = [&](std::size_t corner) -> const Vector& {
    return positions[static_cast<std::size_t>(triangle[corner])];
  };
  const Vector &a = at(0), &b = at(1), &c = at(2);
  Vector area{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    area[k] = (b[l] - a[l]) * (c[m] - a[m]) - (b[m] - a[m]) * (c[l] - a[l]);
  }
  return area;
}

/// `CanopyMeasures::inversion`.
double inversion_of(const CanopyRows& rows, const fabric::Parameters& sheets,
                    const std::vector<Vector>& positions) {
  const fabric::Mesh& mesh = sheets.mesh;
  // Normals at the ends of lines alone.
  std::vector<std::optional<Vector>> normals(rows.cloth_end - rows.begin);
  for (const int line : rows.suspension) normals[ends_of(rows, mesh, line).skirt - rows.begin] = Vector{};
  for (std::size_t t = rows.triangles_begin; t < rows.triangles_end; ++t)
    for (const int i : mesh.triangles[t])
      if (auto& normal = normals[static_cast<std::size_t>(i) - rows.begin]) {
        const Vector area = doubled_area_vector(mesh.triangles[t], positions);
        for (std::size_t k = 0; k < 3; ++k) (*normal)[k] += area[k];
      }
  const Vector cloth = mean_over_mass(rows, sheets.mass, positions);
  std::size_t inverted = 0;
  for (const int line : rows.suspension) {
    const auto [skirt, meeting] = ends_of(rows, mesh, line);
    const Vector& normal = *normals[skirt - rows.begin];
    double outwards = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      outwards += normal[k] * (positions[skirt][k] - 0.75 * cloth[k] - 0.25 * positions[meeting][k]);
    if (outwards < 0.0) ++inverted;
  }
  return rows.suspension.empty()
             ? 0.0
             : static_cast<double>(inverted) / static_cast<double>(rows.suspension.size());
}

/// Squares of the plane of x and y whose centres lie in the projections of triangles.
class Raster {
 public:
  Raster(const Vector& low, double side)
      : _low(low), _side(side), _covered(static_cast<std::size_t>(raster_squares) * raster_squares, 0) {}

  /// Copies, which the squares cannot alias, stay in registers.
  void add(const Vector a, const Vector b, const Vector c) {
    const auto [first_row, last_row] = range(1, a, b, c);
    const auto [first, last] = range(0, a, b, c);
    const double left = _low[0], low = _low[1], side = _side;
    for (int row = first_row; row <= last_row; ++row) {
      char* const covered = &_covered[static_cast<std::size_t>(row) * raster_squares];
      const double y = low + (row + 0.5) * side;
      for (int column = first; column <= last; ++column) {
        const double x = left + (column + 0.5) * side, u = turn(a, b, x, y), v = turn(b, c, x, y),
                     w = turn(c, a, x, y);
        // Without branches, which would be taken at random.
        covered[column] |= static_cast<char>(((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) |
                                             ((u <= 0.0) & (v <= 0.0) & (w <= 0.0)));
      }
    }
  }

  [[nodiscard]] double area() const {
    return _side * _side * static_cast<double>(std::ranges::count(_covered, 1));
  }

 private:
  /// Doubled area of the triangle from the line a, b to a point, m^2.
  static double turn(const Vector& a, const Vector& b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
  }
  [[nodiscard]] std::pair<int, int> range(std::size_t axis, const Vector& a, const Vector& b,
                                          const Vector& c) const {
    const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
    const auto square = [&](double x) {
      return std::clamp(static_cast<int>((x - _low[axis]) / _side), 0, raster_squares - 1);
    };
    return {square(low), square(high)};
  }

  Vector _low;
  double _side;
  std::vector<char> _covered;
};

}  // namespace

double projected_area(std::span<const Vector> positions, std::span<const std::array<int, 3>> triangles) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector low = {infinity, infinity, 0.0}, high = {-infinity, -infinity, 0.0};
  const auto at = [&](int i) -> const Vector& { return positions[static_cast<std::size_t>(i)]; };
  for (const auto& triangle : triangles)
    for (const int i : triangle)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], at(i)[axis]);
        high[axis] = std::max(high[axis], at(i)[axis]);
      }
  const double extent = std::max(high[0] - low[0], high[1] - low[1]);
  if (!(extent > 0.0 && std::isfinite(extent))) return 0.0;
  Raster raster(low, extent / raster_squares);
  for (const auto& [a, b, c] : triangles) raster.add(at(a), at(b), at(c));
  return raster.area();
}

double leak_through(std::span<const std::array<int, 3>> triangles, const SheetState& state) {
  double leak = 0.0;
  for (const auto& triangle : triangles) {
    const Vector area = doubled_area_vector(triangle, state.positions);
    for (const int corner : triangle) {
      const auto i = static_cast<std::size_t>(corner);
      for (std::size_t axis = 0; axis < 3; ++axis)
        leak += area[axis] / 6.0 * (state.air[i][axis] - state.velocities[i][axis]);
    }
  }
  return leak;
}

double lean_of(const CanopyRows& rows, const fabric::Mesh& mesh, std::span<const Vector> positions) {
  if (rows.suspension.empty() || !rows.payload) return 0.0;
  Vector axis{};
  for (const int line : rows.suspension) {
    const Vector& skirt = positions[ends_of(rows, mesh, line).skirt];
    for (std::size_t k = 0; k < 3; ++k) axis[k] += skirt[k] - positions[*rows.payload][k];
  }
  return 180.0 / std::numbers::pi * std::atan2(std::hypot(axis[0], axis[1]), std::abs(axis[2]));
}

CanopyMeasures measure(const CanopyRows& rows, const fabric::Parameters& sheets, const SheetState& state,
                       bool released) {
  const fabric::Mesh& mesh = sheets.mesh;
  CanopyMeasures result;
  for (std::size_t i = rows.begin; i < rows.cloth_end; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) result.force[axis] -= state.on_air[i][axis];
  // A payload on lines has no other forces; one on risers may have several.
  if (rows.payload && !released)
    result.line_force = rows.riser
                            ? pull_of_line(mesh, static_cast<std::size_t>(*rows.riser), state.positions)
                            : state.elastic[*rows.payload];
  result.payload =
      rows.payload ? state.positions[*rows.payload] : mean_over_mass(rows, sheets.mass, state.positions);
  result.velocity =
      rows.payload ? state.velocities[*rows.payload] : mean_over_mass(rows, sheets.mass, state.velocities);
  const std::span triangles =
      std::span(mesh.triangles).subspan(rows.triangles_begin, rows.triangles_end - rows.triangles_begin);
  result.projected_area = projected_area(state.positions, triangles);
  if (!state.air.empty()) result.leak = leak_through(triangles, state);
  double largest = 1.0;
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(triangle[k]),
                 b = static_cast<std::size_t>(triangle[(k + 1) % 3]);
      largest = std::max(largest, squared_distance(state.positions[a], state.positions[b]) /
                                      squared_distance(mesh.rest[a], mesh.rest[b]));
    }
  result.largest_strain = std::sqrt(largest) - 1.0;
  result.inversion = inversion_of(rows, sheets, state.positions);
  result.lean = lean_of(rows, mesh, state.positions);
  return result;
}

double drag_coefficient(const Vector& force, const Vector& velocity, double density, double area) {
  const double speed = std::hypot(velocity[0], velocity[1], velocity[2]),
               pressure = 0.5 * density * speed * speed;
  double along = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) along += force[axis] * velocity[axis];
  return along == 0.0 ? 0.0 : along / (speed * pressure * area);
}

std::vector<fabric::Pull> pulls_on_payloads(const Sheets& sheets) {
  std::vector<fabric::Pull> pulls;
  for (const CanopyRows& rows : sheets.canopies) {
    fabric::Pull& pull = pulls.emplace_back();
    if (!rows.payload) continue;
    pull.vertex = static_cast<int>(*rows.payload);
    pull.lines = rows.riser ? std::vector{*rows.riser} : rows.suspension;
  }
  return pulls;
}

double force_balance(const Vector& total_on_air, std::span<const Vector> on_air) {
  Vector difference = total_on_air;
  double magnitude = 0.0;
  for (const Vector& force : on_air) {
    for (std::size_t axis = 0; axis < 3; ++axis) difference[axis] -= force[axis];
    magnitude += std::hypot(force[0], force[1], force[2]);
  }
  const double sum = std::hypot(difference[0], difference[1], difference[2]);
  return sum == 0.0 ? 0.0 : sum / magnitude;
}

}  // namespace drogue::parachute_app
