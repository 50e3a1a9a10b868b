#include "kernels/reference/fabric/stress.hpp"

#include <cmath>

#include "kernels/reference/vectors.hpp"

namespace drogue::reference {

namespace {

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

using Square = std::array<std::array<double, 2>, 2>;

/// Push-forward of S, times `scale`: sum over a, b of F_ia S_ab F_jb.
Tensor push_forward(const std::array<Vector, 2>& f, const Square& s, double scale) {
  Tensor t{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b) t[i][j] += scale * f[a][i] * s[a][b] * f[b][j];
  return t;
}

Square right_cauchy_green(const std::array<Vector, 2>& f) {
  return {{{product(f[0], f[0]), product(f[0], f[1])}, {product(f[1], f[0]), product(f[1], f[1])}}};
}

double determinant(const Square& c) { return c[0][0] * c[1][1] - c[0][1] * c[1][0]; }

Square times(const Square& a, const Square& b) {
  Square p{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) p[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j];
  return p;
}

Square inverse(const Square& c) {
  const double d = determinant(c);
  return {{{c[1][1] / d, -c[0][1] / d}, {-c[1][0] / d, c[0][0] / d}}};
}

/// Square root of a symmetric positive definite matrix by its eigenvectors.
Square root(const Square& c) {
  const double angle = 0.5 * std::atan2(2.0 * c[0][1], c[0][0] - c[1][1]), x = std::cos(angle),
               y = std::sin(angle);
  const double large = c[0][0] * x * x + 2.0 * c[0][1] * x * y + c[1][1] * y * y;
  const double small = c[0][0] * y * y - 2.0 * c[0][1] * x * y + c[1][1] * x * x;
  const double a = std::sqrt(large), b = std::sqrt(small);
  return {{{a * x * x + b * y * y, (a - b) * x * y}, {(a - b) * x * y, a * y * y + b * x * x}}};
}

}  // namespace

std::array<Vector, 2> deformation(const std::array<Vector, 3>& rest, const std::array<Vector, 3>& now) {
  const Vector e1 = minus(rest[1], rest[0]), e2 = minus(rest[2], rest[0]);
  const double x1 = std::sqrt(product(e1, e1)), x2 = product(e1, e2) / x1,
               y2 = std::sqrt(product(e2, e2) - x2 * x2);
  const Vector d1 = minus(now[1], now[0]), d2 = minus(now[2], now[0]);
  std::array<Vector, 2> f;
  for (std::size_t k = 0; k < 3; ++k) {
    f[0][k] = d1[k] / x1;
    f[1][k] = (d2[k] - x2 * f[0][k]) / y2;
  }
  return f;
}

Tensor cauchy_stress(const fabric::Material& material, const std::array<Vector, 3>& rest,
                     const std::array<Vector, 3>& now) {
  const double young = material.membrane_modulus, nu = material.poisson;
  const std::array<Vector, 2> f = deformation(rest, now);
  const Square c = right_cauchy_green(f);
  const double e11 = 0.5 * (c[0][0] - 1.0), e22 = 0.5 * (c[1][1] - 1.0), e12 = 0.5 * c[0][1];
  const double plane = young / (1.0 - nu * nu);
  const Square s = {{{plane * (e11 + nu * e22), plane * (1.0 - nu) * e12},
                     {plane * (1.0 - nu) * e12, plane * (e22 + nu * e11)}}};
  return push_forward(f, s, 1.0 / std::sqrt(determinant(c)));
}

Tensor virial_stress(const std::array<Vector, 3>& forces, const std::array<Vector, 3>& now) {
  Tensor t{};
  for (std::size_t vertex = 0; vertex < 3; ++vertex)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        t[i][j] -= forces[vertex][i] * now[vertex][j] / area(now[0], now[1], now[2]);
  return t;
}

Tensor nominal_stress(const Tensor& cauchy, const std::array<Vector, 3>& rest,
                      const std::array<Vector, 3>& now) {
  const std::array<Vector, 2> f = deformation(rest, now);
  const Square c = right_cauchy_green(f), u = root(c), back = inverse(u), c_back = inverse(c);
  // S = J F^+ sigma F^+T, with the pseudoinverse F^+ = C^-1 F^T.
  Square inner{};
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) inner[a][b] += f[a][i] * cauchy[i][j] * f[b][j];
  Square s = times(times(c_back, inner), c_back);
  for (auto& row : s)
    for (double& value : row) value *= std::sqrt(determinant(c));
  const Square us = times(u, s);
  const Square biot = {{{us[0][0], 0.5 * (us[0][1] + us[1][0])}, {0.5 * (us[0][1] + us[1][0]), us[1][1]}}};
  // R = F U^-1.
  std::array<Vector, 2> r{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t a = 0; a < 2; ++a) r[a][k] = f[0][k] * back[0][a] + f[1][k] * back[1][a];
  return push_forward(r, biot, 1.0);
}

}  // namespace drogue::reference
