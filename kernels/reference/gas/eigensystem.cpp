#include "kernels/reference/gas/eigensystem.hpp"

namespace drogue::reference {

namespace {

double total_enthalpy(const Conserved& U, double gamma) { return (U[2] + pressure(U, gamma)) / U[0]; }

}  // namespace

FaceState face_state(const Conserved& a, const Conserved& b, gas::FaceAverage average, double gamma) {
  FaceState face;
  if (average == gas::FaceAverage::conserved) {
    const Conserved U = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    face.u = U[1] / U[0];
    face.enthalpy = total_enthalpy(U, gamma);
  } else {
    double weight = 0.5;
    if (average == gas::FaceAverage::roe) weight = std::sqrt(a[0]) / (std::sqrt(a[0]) + std::sqrt(b[0]));
    face.u = weight * (a[1] / a[0]) + (1.0 - weight) * (b[1] / b[0]);
    face.enthalpy = weight * total_enthalpy(a, gamma) + (1.0 - weight) * total_enthalpy(b, gamma);
  }
  face.c = std::sqrt((gamma - 1.0) * (face.enthalpy - 0.5 * face.u * face.u));
  return face;
}

Eigensystem eigensystem(const FaceState& face, double gamma) {
  const double u = face.u;
  const double c = face.c;
  const double b2 = (gamma - 1.0) / (c * c);
  const double b1 = 0.5 * b2 * u * u;
  Eigensystem e;
  e.right = {
      {{1.0, 1.0, 1.0}, {u - c, u, u + c}, {face.enthalpy - u * c, 0.5 * u * u, face.enthalpy + u * c}}};
  e.left = {{{0.5 * (b1 + u / c), -0.5 * (b2 * u + 1.0 / c), 0.5 * b2},
             {1.0 - b1, b2 * u, -b2},
             {0.5 * (b1 - u / c), -0.5 * (b2 * u - 1.0 / c), 0.5 * b2}}};
  return e;
}

std::array<double, 3> multiply(const std::array<std::array<double, 3>, 3>& matrix,
                               const std::array<double, 3>& vector) {
  std::array<double, 3> product{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) product[row] += matrix[row][column] * vector[column];
  return product;
}

}  // namespace drogue::reference
