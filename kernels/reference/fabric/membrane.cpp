#include "kernels/reference/fabric/membrane.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace drogue::reference {

namespace {

template <class T>
using Point = std::array<T, 3>;

template <class T>
Point<T> difference(const Point<T>& a, const Point<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
T dot(const Point<T>& a, const Point<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
T length(const Point<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

/// Of plane stress, N/m: lambda and twice the shear modulus G = E / (2 (1 + nu)).
struct Moduli {
  double lambda, two_g;
};

Moduli plane_stress(double young, double nu) {
  const double g = young / (2.0 * (1.0 + nu));
  return {2.0 * g * nu / (1.0 - nu), 2.0 * g};
}

/// St Venant and Kirchhoff: E = (F^T F - 1) / 2 with F = D_s D_m^-1 in the plane of the triangle at rest.
template <class T>
T continuum_energy(const Moduli& m, const std::array<Vector, 3>& rest, const std::array<Point<T>, 3>& now) {
  // D_m: the rest edges from vertex 0 in an orthonormal basis whose first axis is the first edge.
  const Vector e1 = difference(rest[1], rest[0]), e2 = difference(rest[2], rest[0]);
  const double x1 = length(e1), x2 = dot(e1, e2) / x1, y2 = std::sqrt(dot(e2, e2) - x2 * x2);
  const Point<T> d1 = difference(now[1], now[0]), d2 = difference(now[2], now[0]);
  // Columns of F.
  Point<T> f1, f2;
  for (std::size_t k = 0; k < 3; ++k) {
    f1[k] = d1[k] / x1;
    f2[k] = (d2[k] - f1[k] * x2) / y2;
  }
  const T e11 = 0.5 * (dot(f1, f1) - 1.0), e22 = 0.5 * (dot(f2, f2) - 1.0), e12 = 0.5 * dot(f1, f2);
  const T trace = e11 + e22;
  return 0.5 * x1 * y2 *
         (0.5 * m.lambda * trace * trace + 0.5 * m.two_g * (e11 * e11 + e22 * e22 + 2.0 * e12 * e12));
}

/// Sums of k_i dl_i^2 / 2 and gamma_i dl_j dl_k.
template <class T>
T delingette_energy(const Moduli& m, const std::array<Vector, 3>& rest, const std::array<Point<T>, 3>& now) {
  double rest_length[3], cotangent[3];
  T change[3];
  const double eight_areas = 8.0 * area(rest[0], rest[1], rest[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    rest_length[i] = length(difference(rest[k], rest[j]));
    change[i] = length(difference(now[k], now[j])) - rest_length[i];
    cotangent[i] = 4.0 * dot(difference(rest[j], rest[i]), difference(rest[k], rest[i])) / eight_areas;
  }
  T sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double stiffness = rest_length[i] * rest_length[i] *
                             (2.0 * cotangent[i] * cotangent[i] * (m.lambda + m.two_g) + m.two_g) /
                             eight_areas;
    const double angular = rest_length[j] * rest_length[k] *
                           (2.0 * cotangent[j] * cotangent[k] * (m.lambda + m.two_g) - m.two_g) / eight_areas;
    sum += 0.5 * stiffness * change[i] * change[i] + angular * change[j] * change[k];
  }
  return sum;
}

std::array<int, 2> sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

double area(const Vector& a, const Vector& b, const Vector& c) {
  const Vector u = difference(b, a), v = difference(c, a);
  const Vector cross = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  return 0.5 * length(cross);
}

template <class T>
T triangle_energy(const fabric::Material& material, const std::array<Vector, 3>& rest,
                  const std::array<Point<T>, 3>& now) {
  const Moduli m = plane_stress(material.membrane_modulus, material.poisson);
  return material.model == fabric::Model::quadratic ? delingette_energy(m, rest, now)
                                                    : continuum_energy(m, rest, now);
}

template <class T>
T spring_energy(fabric::Model model, double k, const std::array<Vector, 2>& rest,
                const std::array<Point<T>, 2>& now) {
  const Vector at_rest = difference(rest[1], rest[0]);
  const Point<T> edge = difference(now[1], now[0]);
  if (model == fabric::Model::linear_vector) {
    const Point<T> change = {edge[0] - at_rest[0], edge[1] - at_rest[1], edge[2] - at_rest[2]};
    return 0.5 * k * dot(change, change);
  }
  const T change = length(edge) - length(at_rest);
  return 0.5 * k * change * change;
}

template double triangle_energy(const fabric::Material&, const std::array<Vector, 3>&,
                                const std::array<Point<double>, 3>&);
template double spring_energy(fabric::Model, double, const std::array<Vector, 2>&,
                              const std::array<Point<double>, 2>&);

std::vector<std::array<int, 2>> triangle_edges(const Mesh& mesh) {
  std::set<std::array<int, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(sorted(t[k], t[(k + 1) % 3]));
  return {edges.begin(), edges.end()};
}

namespace {

/// Calls `visit(vertices, energy)` for everything that stores energy; `energy` takes their coordinates.
template <class Visit>
void for_elements(const fabric::Material& material, const Mesh& mesh, const Visit& visit) {
  const auto at_rest = [&](int i) { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto spring = [&](const std::array<int, 2>& ends, fabric::Model model, double k) {
    const std::array<Vector, 2> rest = {at_rest(ends[0]), at_rest(ends[1])};
    visit(ends, [=](const auto& now) { return spring_energy(model, k, rest, now); });
  };
  if (fabric::has_triangles(material.model)) {
    for (const auto& t : mesh.triangles) {
      const std::array<Vector, 3> rest = {at_rest(t[0]), at_rest(t[1]), at_rest(t[2])};
      visit(t, [=, &material](const auto& now) { return triangle_energy(material, rest, now); });
    }
  } else {
    for (const auto& edge : triangle_edges(mesh)) spring(edge, material.model, material.stiffness);
  }
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto& line = mesh.lines[k];
    const double rest = length(difference(at_rest(line[1]), at_rest(line[0])));
    const double axial = mesh.line_stiffness.empty() ? material.axial_stiffness : mesh.line_stiffness[k];
    spring(line, fabric::Model::edge, axial / rest);
  }
}

}  // namespace

double energy(const fabric::Material& material, const Mesh& mesh, const std::vector<Vector>& now) {
  double sum = 0.0;
  for_elements(material, mesh, [&](const auto& vertices, const auto& of) {
    std::array<Point<double>, std::tuple_size_v<std::decay_t<decltype(vertices)>>> x;
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = now[static_cast<std::size_t>(vertices[k])];
    sum += of(x);
  });
  return sum;
}

std::vector<Vector> forces(const fabric::Material& material, const Mesh& mesh,
                           const std::vector<Vector>& now) {
  constexpr double step = 1e-100;
  std::vector<Vector> force(now.size(), Vector{});
  for_elements(material, mesh, [&](const auto& vertices, const auto& of) {
    std::array<Point<std::complex<double>>, std::tuple_size_v<std::decay_t<decltype(vertices)>>> x;
    for (std::size_t k = 0; k < x.size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        x[k][axis] = now[static_cast<std::size_t>(vertices[k])][axis];
    for (std::size_t k = 0; k < x.size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[k][axis] += std::complex<double>(0.0, step);
        force[static_cast<std::size_t>(vertices[k])][axis] -= of(x).imag() / step;
        x[k][axis] = x[k][axis].real();
      }
  });
  return force;
}

}  // namespace drogue::reference
