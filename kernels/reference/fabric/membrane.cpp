#include "kernels/reference/fabric/membrane.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <type_traits>

namespace drogue::reference {

namespace {

template <class T>
using Coordinates = std::array<T, 3>;

template <class T>
Coordinates<T> difference(const Coordinates<T>& a, const Coordinates<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
T dot(const Coordinates<T>& a, const Coordinates<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
T length(const Coordinates<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

/// Moduli of plane stress, N/m: lambda, and twice the shear modulus G = E / (2 (1 + nu)).
struct Moduli {
  double lambda, two_g;
};

Moduli plane_stress(double young, double nu) {
  const double g = young / (2.0 * (1.0 + nu));
  return {2.0 * g * nu / (1.0 - nu), 2.0 * g};
}

double real_part(double a) { return a; }
double real_part(const std::complex<double>& a) { return a.real(); }

/// Strain in the plane of a triangle at rest.
template <class T>
struct Strain {
  T e11, e22, e12;
};

/// D_m: edges from vertex 0 at rest, m, in an orthonormal basis whose first axis is the first edge.
struct RestShape {
  double x1, x2, y2;
};

RestShape rest_shape(const std::array<Vector, 3>& rest) {
  const Vector e1 = difference(rest[1], rest[0]), e2 = difference(rest[2], rest[0]);
  const double x1 = length(e1), x2 = dot(e1, e2) / x1;
  return {x1, x2, std::sqrt(dot(e2, e2) - x2 * x2)};
}

/// Green's strain E = (F^T F - 1) / 2, with F = D_s D_m^-1.
template <class T>
Strain<T> green_strain(const std::array<Vector, 3>& rest, const std::array<Coordinates<T>, 3>& now) {
  const RestShape m = rest_shape(rest);
  const Coordinates<T> d1 = difference(now[1], now[0]), d2 = difference(now[2], now[0]);
  // Columns of F.
  Coordinates<T> f1, f2;
  for (std::size_t k = 0; k < 3; ++k) {
    f1[k] = d1[k] / m.x1;
    f2[k] = (d2[k] - f1[k] * m.x2) / m.y2;
  }
  return {0.5 * (dot(f1, f1) - 1.0), 0.5 * (dot(f2, f2) - 1.0), 0.5 * dot(f1, f2)};
}

/// Strain of Delingette's quadratic springs: squared edge lengths change by 2 L (l - L) instead of l^2 - L^2.
/// Solves d^T E d = L (l - L) for the three edges d.
template <class T>
Strain<T> strain_of_lengths(const std::array<Vector, 3>& rest, const std::array<Coordinates<T>, 3>& now) {
  const RestShape m = rest_shape(rest);
  const auto change = [&](std::size_t i, std::size_t j) {
    const double at_rest = length(difference(rest[j], rest[i]));
    return at_rest * (length(difference(now[j], now[i])) - at_rest);
  };
  const T first = change(0, 1), second = change(0, 2), third = change(1, 2);
  const double across = m.x2 - m.x1;
  const T e11 = first / (m.x1 * m.x1);
  // Edges (x2, y2) and (x2 - x1, y2), with the terms of e11 subtracted, give two equations for e12 and e22.
  const T u = second - e11 * m.x2 * m.x2, v = third - e11 * across * across;
  const T e12 = (u - v) / (2.0 * m.y2 * m.x1);
  return {e11, (u - 2.0 * m.x2 * m.y2 * e12) / (m.y2 * m.y2), e12};
}

/// St Venant-Kirchhoff energy per rest area, J/m^2.
template <class T>
T strain_energy(const Moduli& m, const Strain<T>& e) {
  const T trace = e.e11 + e.e22;
  return 0.5 * m.lambda * trace * trace +
         0.5 * m.two_g * (e.e11 * e.e11 + e.e22 * e.e22 + 2.0 * e.e12 * e.e12);
}

/// Quasiconvex hull of `strain_energy` (Pipkin 1986), J/m^2, by cases of the principal strains: zero if both
/// are negative; uniaxial tension if the minor one is below -nu times the major one; else unchanged.
template <class T>
T relaxed_energy(const fabric::Material& material, const Strain<T>& e) {
  using std::sqrt;
  const double nu = material.poisson;
  const T mean = 0.5 * (e.e11 + e.e22), half = 0.5 * (e.e11 - e.e22);
  const T radius = sqrt(half * half + e.e12 * e.e12), major = mean + radius, minor = mean - radius;
  if (real_part(minor) >= -nu * real_part(major) && real_part(major) > 0.0)
    return strain_energy(plane_stress(material.membrane_modulus, nu), e);
  if (real_part(major) > 0.0) return 0.5 * material.membrane_modulus * major * major;
  return 0.0;
}

/// Energy of tensile and angular springs, J: sum of k_i dl_i^2 / 2 + gamma_i dl_j dl_k.
template <class T>
T delingette_energy(const Moduli& m, const std::array<Vector, 3>& rest,
                    const std::array<Coordinates<T>, 3>& now) {
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
                  const std::array<Coordinates<T>, 3>& now) {
  const Moduli m = plane_stress(material.membrane_modulus, material.poisson);
  const bool of_lengths = material.model == fabric::Model::quadratic;
  const double at_rest = area(rest[0], rest[1], rest[2]);
  if (material.tension_only)
    return at_rest *
           relaxed_energy(material, of_lengths ? strain_of_lengths(rest, now) : green_strain(rest, now));
  return of_lengths ? delingette_energy(m, rest, now) : at_rest * strain_energy(m, green_strain(rest, now));
}

template <class T>
T spring_energy(fabric::Model model, bool tension_only, double k, const std::array<Vector, 2>& rest,
                const std::array<Coordinates<T>, 2>& now) {
  const Vector at_rest = difference(rest[1], rest[0]);
  const Coordinates<T> edge = difference(now[1], now[0]);
  if (model == fabric::Model::linear_vector) {
    const Coordinates<T> change = {edge[0] - at_rest[0], edge[1] - at_rest[1], edge[2] - at_rest[2]};
    return 0.5 * k * dot(change, change);
  }
  const T change = length(edge) - length(at_rest);
  if (tension_only && real_part(change) < 0.0) return 0.0;
  return 0.5 * k * change * change;
}

template double triangle_energy(const fabric::Material&, const std::array<Vector, 3>&,
                                const std::array<Coordinates<double>, 3>&);
template double spring_energy(fabric::Model, bool, double, const std::array<Vector, 2>&,
                              const std::array<Coordinates<double>, 2>&);

std::vector<std::array<int, 2>> triangle_edges(const Mesh& mesh) {
  std::set<std::array<int, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(sorted(t[k], t[(k + 1) % 3]));
  return {edges.begin(), edges.end()};
}

namespace {

/// Calls `visit(vertices, energy)` for every element; `energy` maps the positions of its vertices to J.
template <class Visit>
void for_elements(const fabric::Material& material, const Mesh& mesh, const Visit& visit) {
  const auto at_rest = [&](int i) { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto spring_between = [&](const std::array<int, 2>& ends, const std::array<Vector, 2>& rest,
                                  fabric::Model model, double k) {
    visit(ends, [=, &material](const auto& now) {
      return spring_energy(model, material.tension_only, k, rest, now);
    });
  };
  const auto spring = [&](const std::array<int, 2>& ends, fabric::Model model, double k) {
    spring_between(ends, {at_rest(ends[0]), at_rest(ends[1])}, model, k);
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
    double rest = length(difference(at_rest(line[1]), at_rest(line[0])));
    if (!mesh.line_length.empty() && mesh.line_length[k] > 0.0) rest = mesh.line_length[k];
    const double axial = mesh.line_stiffness.empty() ? material.axial_stiffness : mesh.line_stiffness[k];
    // The energy of Model II depends on the distance at rest alone.
    spring_between(line, {Vector{}, Vector{rest, 0.0, 0.0}}, fabric::Model::edge, axial / rest);
  }
}

}  // namespace

double energy(const fabric::Material& material, const Mesh& mesh, const std::vector<Vector>& now) {
  double sum = 0.0;
  for_elements(material, mesh, [&](const auto& vertices, const auto& of) {
    std::array<Coordinates<double>, std::tuple_size_v<std::decay_t<decltype(vertices)>>> x;
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
    std::array<Coordinates<std::complex<double>>, std::tuple_size_v<std::decay_t<decltype(vertices)>>> x;
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
