#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

#include "kernels/gas/flux/limiter.hpp"
#include "kernels/reference/gas/eigensystem.hpp"
#include "kernels/reference/gas/face_flux.hpp"
#include "kernels/reference/gas/limiter.hpp"
#include "tests/support/gas_state.hpp"

// Point functions of a stage, one face per thread, against the dense form with full matrices.

namespace drogue::gas {
namespace {

using Space = DROGUE_TEST_SPACE;
using Memory = Space::memory_space;
using drogue::testing::RandomGas;
using reference::Conserved;
using Cells = std::array<Conserved, 6>;

constexpr int faces = 2000;
constexpr double gamma = 1.4;

using Stencils = Kokkos::View<double* [6][3], Memory>;
using ConservedVectors = Kokkos::View<double* [3], Memory>;

template <Reconstruction scheme, class N>
struct FluxFunctor {
  Stencils stencil;
  ConservedVectors alpha, flux;
  FaceAverage average;

  KOKKOS_FUNCTION void operator()(const int face) const {
    Stencil<double> s;
    FaceCell<double> beside[2];
    ConservedVector<double> state[6], physical[6];
    for (int k = 0; k < 6; ++k) {
      const CellState<double> c =
          cell_state<double>(gamma, stencil(face, k, 0), stencil(face, k, 1), stencil(face, k, 2));
      state[k] = {c.rho, c.m, c.energy};
      physical[k] = {c.m, c.m * c.u + c.p, (c.energy + c.p) * c.u};
      if (k == 2 || k == 3) beside[k - 2] = {c.rho, c.m, c.energy, c.u, c.enthalpy};
    }
    for (int k = 0; k < 5; ++k) {
      s.d_state[k] = {state[k + 1].rho - state[k].rho, state[k + 1].m - state[k].m,
                      state[k + 1].energy - state[k].energy};
      s.d_flux_m[k] = physical[k + 1].m - physical[k].m;
      s.d_flux_energy[k] = physical[k + 1].energy - physical[k].energy;
    }
    s.flux_sum = {physical[2].rho + physical[3].rho, physical[2].m + physical[3].m,
                  physical[2].energy + physical[3].energy};
    const auto e = face_eigensystem<N, double>(average, gamma, beside[0], beside[1]);
    const WaveSpeeds<N> speeds{static_cast<N>(alpha(face, 0)), static_cast<N>(alpha(face, 1)),
                               static_cast<N>(alpha(face, 2))};
    const ConservedVector<double> f = weno5_face<scheme, N>(s, e, speeds);
    flux(face, 0) = f.rho, flux(face, 1) = f.m, flux(face, 2) = f.energy;
  }
};

template <Reconstruction scheme>
void launch(Precision precision, const Stencils& stencil, const ConservedVectors& alpha,
            const ConservedVectors& flux, FaceAverage average) {
  const Kokkos::RangePolicy<Space> range(0, faces);
  if (precision == Precision::full)
    Kokkos::parallel_for("gas_point_test", range, FluxFunctor<scheme, double>{stencil, alpha, flux, average});
  else
    Kokkos::parallel_for("gas_point_test", range, FluxFunctor<scheme, float>{stencil, alpha, flux, average});
}

void launch(const Parameters& p, const Stencils& stencil, const ConservedVectors& alpha,
            const ConservedVectors& flux) {
  switch (p.weno) {
    case Weno::js:
      return launch<Reconstruction::js>(p.precision, stencil, alpha, flux, p.face_average);
    case Weno::m:
      return launch<Reconstruction::m>(p.precision, stencil, alpha, flux, p.face_average);
    case Weno::teno5:
      return launch<Reconstruction::teno5>(p.precision, stencil, alpha, flux, p.face_average);
    case Weno::z:
      break;
  }
  if (p.weno_power == 1)
    launch<Reconstruction::z1>(p.precision, stencil, alpha, flux, p.face_average);
  else
    launch<Reconstruction::z2>(p.precision, stencil, alpha, flux, p.face_average);
}

struct Sample {
  std::vector<Cells> stencil;
  std::vector<std::array<double, 3>> alpha;
};

/// Waves of amplitude `amplitude`, or independent states in all cells if it is zero. Every third face uses
/// the alphas of its stencil, the others larger ones.
Sample sample(double amplitude, unsigned seed) {
  RandomGas random(seed);
  Sample made;
  for (int face = 0; face < faces; ++face) {
    Cells cells;
    const reference::Primitive base = random.primitive({0.1, 10, 0.1, 10, 3});
    const double phase = random.uniform(0, 6.3), wave = random.uniform(0.2, 0.5);
    for (int k = 0; k < 6; ++k) {
      reference::Primitive w = random.primitive({0.1, 10, 0.1, 10, 3});
      const double s = amplitude * std::sin(phase + wave * k), c = amplitude * std::cos(phase + 1 + wave * k);
      if (amplitude > 0) w = {base.rho * (1 + s), base.u + c, base.p * (1 + 0.5 * s + c)};
      cells[static_cast<std::size_t>(k)] = reference::to_conserved(w, gamma);
    }
    std::array<double, 3> alpha = reference::speed_bounds(cells, gamma).field;
    if (face % 3 != 0)
      for (double& value : alpha) value *= random.uniform(1, 3);
    made.stencil.push_back(cells);
    made.alpha.push_back(alpha);
  }
  return made;
}

std::vector<Conserved> kernel_fluxes(const Parameters& p, const Sample& in) {
  const Stencils stencil("stencil", faces);
  const ConservedVectors alpha("alpha", faces), flux("flux", faces);
  const auto host_stencil = Kokkos::create_mirror_view(stencil);
  const auto host_alpha = Kokkos::create_mirror_view(alpha);
  for (std::size_t face = 0; face < faces; ++face)
    for (std::size_t field = 0; field < 3; ++field) {
      host_alpha(face, field) = in.alpha[face][field];
      for (std::size_t k = 0; k < 6; ++k) host_stencil(face, k, field) = in.stencil[face][k][field];
    }
  Kokkos::deep_copy(stencil, host_stencil);
  Kokkos::deep_copy(alpha, host_alpha);
  launch(p, stencil, alpha, flux);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, flux);
  std::vector<Conserved> out;
  for (std::size_t face = 0; face < faces; ++face)
    out.push_back({host(face, 0), host(face, 1), host(face, 2)});
  return out;
}

/// Scale of the rounding errors: the maximum of |R| |L| (|F| + alpha |U|) over the cells of the stencil, or
/// over their differences if only those are rounded.
Conserved rounding_scale(const Parameters& p, const Cells& cells, const std::array<double, 3>& alpha,
                         bool differences) {
  const auto basis =
      reference::eigensystem(reference::face_state(cells[2], cells[3], p.face_average, gamma), gamma);
  Conserved scale{};
  for (std::size_t field = 0; field < 3; ++field) {
    double largest = 0.0;
    for (std::size_t k = differences ? 1 : 0; k < 6; ++k) {
      Conserved u = cells[k], f = reference::physical_flux(cells[k], gamma);
      if (differences) {
        const Conserved before = reference::physical_flux(cells[k - 1], gamma);
        for (std::size_t s = 0; s < 3; ++s) u[s] -= cells[k - 1][s], f[s] -= before[s];
      }
      double sum = 0.0;
      for (std::size_t s = 0; s < 3; ++s)
        sum += std::abs(basis.left[field][s]) * (std::abs(f[s]) + alpha[field] * std::abs(u[s]));
      largest = std::max(largest, sum);
    }
    for (std::size_t s = 0; s < 3; ++s) scale[s] += std::abs(basis.right[s][field]) * largest;
  }
  return scale;
}

/// Scaled errors in ascending order, three per face.
std::vector<double> flux_errors(const Parameters& p, double amplitude) {
  const Sample in = sample(amplitude, 7);
  const std::vector<Conserved> got = kernel_fluxes(p, in);
  std::vector<double> errors;
  for (std::size_t face = 0; face < faces; ++face) {
    const Conserved exact = reference::face_flux(in.stencil[face], in.alpha[face], p);
    const Conserved scale =
        rounding_scale(p, in.stencil[face], in.alpha[face], p.precision == Precision::split);
    for (std::size_t s = 0; s < 3; ++s) {
      const double error = std::abs(got[face][s] - exact[s]) / scale[s];
      errors.push_back(std::isfinite(error) ? error : INFINITY);
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

/// Calls `check(parameters, text)` for every scheme and average.
template <class Check>
void for_schemes(const Check& check) {
  struct Scheme {
    Weno weno;
    int power;
    const char* name;
  };
  for (const Scheme& scheme : {Scheme{Weno::js, 1, "js"}, Scheme{Weno::z, 1, "z1"}, Scheme{Weno::z, 2, "z2"},
                               Scheme{Weno::m, 1, "m"}, Scheme{Weno::teno5, 1, "teno5"}})
    for (const FaceAverage average : {FaceAverage::arithmetic, FaceAverage::conserved, FaceAverage::roe}) {
      Parameters p;
      p.weno = scheme.weno;
      p.weno_power = scheme.power;
      p.face_average = average;
      check(p, std::string(scheme.name) + ", mean " + std::to_string(static_cast<int>(average)));
    }
}

TEST(GasPoint, FaceFluxesMatchTheDenseForm) {
  for_schemes([](const Parameters& p, const std::string& text) {
    for (const double amplitude : {0.0, 0.1, 1e-3, 1e-6})
      EXPECT_LT(flux_errors(p, amplitude).back(), 1e-14) << text << ", amplitude " << amplitude;
  });
}

TEST(GasPoint, SplitPrecisionRoundsOnlyTheNonlinearTerms) {
  for_schemes([](Parameters p, const std::string& text) {
    p.precision = Precision::split;
    for (const double amplitude : {0.0, 0.1, 1e-3, 1e-6}) {
      // TENO5 keeps or drops a stencil: one face in a thousand may fall on the other side of the cut-off.
      const std::vector<double> errors = flux_errors(p, amplitude);
      EXPECT_LT(errors[errors.size() * 999 / 1000], 2e-6) << text << ", amplitude " << amplitude;
      EXPECT_LT(errors.back(), 0.1) << text << ", amplitude " << amplitude;
    }
  });
}

/// Gas at rest with waves of `amplitude` and increasing temperature: p/rho from `coldest` to `hottest`.
Sample temperatures(double coldest, double hottest, double amplitude) {
  Sample made;
  for (int face = 0; face < faces; ++face) {
    const double p = coldest * std::pow(hottest / coldest, face / (faces - 1.0));
    Cells cells;
    for (int k = 0; k < 6; ++k) {
      const double s = amplitude * std::sin(1.0 + 0.4 * k);
      cells[static_cast<std::size_t>(k)] = reference::to_conserved({1 + s, 0.0, p * (1 - s)}, gamma);
    }
    made.stencil.push_back(cells);
    made.alpha.push_back(reference::speed_bounds(cells, gamma).field);
  }
  return made;
}

// Products of indicators scale with the eighth power of a difference, whose unit is that of c^2.
TEST(GasPoint, FluxesAreFiniteAtExtremeTemperatures) {
  for_schemes([](Parameters p, const std::string& text) {
    for (const Precision precision : {Precision::full, Precision::split}) {
      p.precision = precision;
      const bool single = precision == Precision::split;
      for (const double amplitude : {0.0, 1e-6, 0.5}) {
        const Sample in = temperatures(single ? 1e-12 : 1e-30, single ? 1e14 : 1e20, amplitude);
        const auto got = kernel_fluxes(p, in);
        for (std::size_t face = 0; face < faces; ++face)
          ASSERT_TRUE(std::isfinite(got[face][0]) && std::isfinite(got[face][1]) &&
                      std::isfinite(got[face][2]))
              << text << (single ? ", split" : "") << ", amplitude " << amplitude << ", face " << face;
      }
    }
  });
}

// ---- the limiter ----

struct LimitFunctor {
  Stencils in;  ///< per face: left state, right state, high flux, low flux
  ConservedVectors flux;
  Kokkos::View<double*, Memory> theta;
  double lambda;

  KOKKOS_FUNCTION ConservedVector<double> vector(int face, int k) const {
    return {in(face, k, 0), in(face, k, 1), in(face, k, 2)};
  }
  KOKKOS_FUNCTION void operator()(const int face) const {
    const auto result =
        limit(vector(face, 0), vector(face, 1), vector(face, 2), vector(face, 3), 2.0 * lambda, gamma);
    flux(face, 0) = result.flux.rho, flux(face, 1) = result.flux.m, flux(face, 2) = result.flux.energy;
    theta(face) = result.theta;
  }
};

TEST(GasPoint, LimiterMatchesTheReferenceAndKeepsCellsPositive) {
  RandomGas random(3);
  const Stencils in("in", faces);
  const ConservedVectors flux("flux", faces);
  const Kokkos::View<double*, Memory> theta("theta", faces);
  const auto host = Kokkos::create_mirror_view(in);
  const double lambda = 0.002;  // alpha = 250 exceeds every wave speed of these states
  std::vector<std::array<Conserved, 4>> cases;
  for (std::size_t face = 0; face < faces; ++face) {
    const Conserved a = reference::to_conserved(random.primitive(drogue::testing::extreme), gamma);
    const Conserved b = reference::to_conserved(random.primitive(drogue::testing::extreme), gamma);
    const Conserved low = reference::lax_friedrichs_flux(a, b, 0.5 / lambda, gamma);
    Conserved high = low;
    // The flux perturbation ranges from negligible to far too large.
    const double size = random.log_uniform(1e-3, 3.0);
    for (std::size_t s = 0; s < 3; ++s)
      high[s] += size / lambda * random.uniform(-1, 1) * std::max(a[s], b[s]);
    cases.push_back({a, b, high, low});
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t s = 0; s < 3; ++s) host(face, k, s) = cases.back()[k][s];
  }
  Kokkos::deep_copy(in, host);
  Kokkos::parallel_for("gas_point_test", Kokkos::RangePolicy<Space>(0, faces),
                       LimitFunctor{in, flux, theta, lambda});
  const auto got = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, flux);
  const auto got_theta = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, theta);
  int limited_faces = 0;
  for (std::size_t face = 0; face < faces; ++face) {
    const auto& [a, b, high, low] = cases[face];
    const auto exact = reference::limit_flux(high, low, a, b, lambda, gamma);
    EXPECT_EQ(got_theta(face) < 1.0, exact.limited);
    limited_faces += exact.limited ? 1 : 0;
    Conserved left{}, right{};
    for (std::size_t s = 0; s < 3; ++s) {
      const double scale = std::abs(high[s]) + std::abs(low[s]);
      EXPECT_NEAR(got(face, s), exact.flux[s], 1e-9 * scale);
      if (!exact.limited) {
        EXPECT_EQ(got(face, s), high[s]);
      }
      left[s] = a[s] - 2.0 * lambda * got(face, s);
      right[s] = b[s] + 2.0 * lambda * got(face, s);
    }
    for (const Conserved& share : {left, right}) {
      EXPECT_GT(share[0], 0.0);
      EXPECT_GT(reference::pressure(share, gamma), -1e-15 * share[2]);
    }
  }
  EXPECT_GT(limited_faces, faces / 4);
  EXPECT_LT(limited_faces, faces * 3 / 4);
}

}  // namespace
}  // namespace drogue::gas
