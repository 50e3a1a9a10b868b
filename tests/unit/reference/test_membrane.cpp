#include "kernels/reference/fabric/membrane.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/fabric_mesh.hpp"

namespace drogue::reference {
namespace {

using fabric::Material;
using fabric::Model;
using testing::random_patch;
using testing::shaken;

Material cloth(Model model) {
  Material m;
  m.model = model;
  m.axial_stiffness = 70.0;
  return m;
}

TEST(ReferenceMembrane, ForcesAreGradientsOfTheEnergy) {
  const Mesh mesh = random_patch(3, 3, 1);
  for (const Model model : {Model::linear_vector, Model::edge, Model::quadratic, Model::biquadratic}) {
    const std::vector<Vector> now = shaken(mesh.rest, 0.2, 2), f = forces(cloth(model), mesh, now);
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Vector> more = now, less = now;
        more[i][axis] += 1e-5, less[i][axis] -= 1e-5;
        const double slope = (energy(cloth(model), mesh, more) - energy(cloth(model), mesh, less)) / 2e-5;
        EXPECT_NEAR(f[i][axis], -slope, 1e-5);
      }
  }
}

/// lambda and twice the shear modulus of plane stress.
std::pair<double, double> moduli_of(double young, double nu) {
  return {young * nu / (1.0 - nu * nu), young / (1.0 + nu)};
}

/// Delingette's biquadratic springs: k_i d_i^2 / 2 and gamma_i d_j d_k with d = (l^2 - L^2) / (2 L); `g` is
/// the value in place of twice the shear modulus.
double biquadratic_springs(double lambda, double g, const std::array<Vector, 3>& rest,
                           const std::array<Vector, 3>& now) {
  const auto squared = [](const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
    return sum;
  };
  double length2[3], d[3], cotangent[3], sum = 0.0;
  const double eight_areas = 8.0 * area(rest[0], rest[1], rest[2]);
  for (std::size_t i = 0; i < 3; ++i) length2[i] = squared(rest[(i + 1) % 3], rest[(i + 2) % 3]);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    d[i] = (squared(now[j], now[k]) - length2[i]) / (2.0 * std::sqrt(length2[i]));
    cotangent[i] = 2.0 * (length2[j] + length2[k] - length2[i]) / eight_areas;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sum += 0.5 * length2[i] * (2.0 * cotangent[i] * cotangent[i] * (lambda + g) + g) / eight_areas * d[i] *
               d[i] +
           std::sqrt(length2[j] * length2[k]) * (2.0 * cotangent[j] * cotangent[k] * (lambda + g) - g) /
               eight_areas * d[j] * d[k];
  }
  return sum;
}

TEST(ReferenceMembrane, BiquadraticSpringsEqualStVenantKirchhoff) {
  const Material m = cloth(Model::biquadratic);
  const auto [lambda, two_g] = moduli_of(m.membrane_modulus, m.poisson);
  const Mesh mesh = random_patch(6, 6, 4);
  const std::vector<Vector> now = shaken(mesh.rest, 0.3, 5);
  for (const auto& t : mesh.triangles) {
    std::array<Vector, 3> rest, moved;
    for (std::size_t k = 0; k < 3; ++k)
      rest[k] = mesh.rest[static_cast<std::size_t>(t[k])], moved[k] = now[static_cast<std::size_t>(t[k])];
    const double springs = biquadratic_springs(lambda, two_g, rest, moved),
                 continuum = triangle_energy(m, rest, moved);
    EXPECT_NEAR(springs, continuum, 1e-12 * continuum);
  }
}

struct Apparent {
  double modulus, poisson;
};

/// Young's modulus and Poisson's ratio of a free strip under small strain, from the energy per area of a
/// triangle that stretches by a along x and b along y.
template <class Energy>
Apparent apparent(const Energy& of) {
  const std::array<Vector, 3> rest = {Vector{0, 0, 0}, Vector{1.3, 0.1, 0}, Vector{0.4, 0.9, 0}};
  const double h = 1e-3, unit = area(rest[0], rest[1], rest[2]);
  const auto w = [&](double a, double b) {
    std::array<Vector, 3> now = rest;
    for (Vector& x : now) x = {x[0] * (1.0 + a), x[1] * (1.0 + b), 0.0};
    return of(rest, now) / unit;
  };
  const double c11 = (w(h, 0) + w(-h, 0)) / (h * h), c22 = (w(0, h) + w(0, -h)) / (h * h);
  const double c12 = (w(h, h) - w(h, -h) - w(-h, h) + w(-h, -h)) / (4.0 * h * h);
  return {c11 - c12 * c12 / c22, c12 / c22};
}

TEST(ReferenceMembrane, MaterialReproducesModulusAndPoissonRatio) {
  for (const double poisson : {0.0, 0.14, 0.3, 0.45})
    for (const Model model : {Model::quadratic, Model::biquadratic}) {
      Material m = cloth(model);
      m.poisson = poisson;
      const auto [modulus, ratio] =
          apparent([&](const auto& rest, const auto& now) { return triangle_energy(m, rest, now); });
      EXPECT_NEAR(modulus / m.membrane_modulus, 1.0, 1e-5);
      EXPECT_NEAR(ratio, poisson, 1e-5);
    }
}

TEST(ReferenceMembrane, OrdinaryShearModulusGivesAnotherMaterial) {
  // mu of [Shi] is twice the shear modulus.
  for (const double nu : {0.14, 0.3}) {
    const auto [lambda, two_g] = moduli_of(1000.0, nu);
    const auto [modulus, ratio] = apparent([&](const auto& rest, const auto& now) {
      return biquadratic_springs(lambda, 0.5 * two_g, rest, now);
    });
    EXPECT_NEAR(modulus / 1000.0, (1.0 + 3.0 * nu) / (2.0 * (1.0 + nu) * (1.0 + nu)), 1e-5);
    EXPECT_NEAR(ratio, 2.0 * nu / (1.0 + nu), 1e-5);
  }
}

}  // namespace
}  // namespace drogue::reference
