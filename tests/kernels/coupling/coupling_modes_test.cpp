#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/coupling/sheet/surface_mean.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"
#include "kernels/reference/coupling/sheet_mode.hpp"
#include "kernels/reference/coupling/surface.hpp"
#include "kernels/reference/flow/step.hpp"
#include "tests/support/coupled_case.hpp"

// Coupled steps of single modes against their analysis: a piston on a spring, and a taut sheet that moves as
// a sine.

namespace drogue::coupling {
namespace {

using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using fabric::Vector;
using reference::SheetMode;
using reference::SheetModeParameters;

constexpr double h = 0.1, closed = std::numeric_limits<double>::infinity();

/// Velocities so small that the weights of the delta functions stay the same, m/s.
constexpr double slow = 1e-6;

void set_law(CoupledCase& c, double alpha) {
  c.p.sheet.law = {alpha == closed ? 0.0 : alpha, 0.0, alpha == closed};
}

/// Vertex in the middle of a strip of eight segments.
constexpr std::size_t middle = 8;

/// Piston of 0.0373 kg/m^2 across a periodic channel of air of 16 cells, on springs of a stiffness per area,
/// Pa/m.
struct Piston {
  static constexpr double mass = 0.0373;

  Piston(double omega_dt, double alpha, double filter) : c(16, 4, h, 0.01) {
    c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
    const std::vector<Vector> places = c.x;
    c.p.fabric.pinned.assign(places.size(), 6);
    c.set_mass(mass);
    c.v.assign(places.size(), {slow, 0.0, 0.0});
    p.mass = mass;
    p.alpha = alpha, p.filter = c.p.sheet.filter = filter;
    p.dt = c.p.flow.fixed_dt;
    p.substeps = c.p.substeps = 12;
    set_law(c, alpha);
    // Two vertices share the corners of the periodic box; those at its ends have half the area.
    std::vector<double> areas;
    for (const double of_vertex : c.p.fabric.mass) areas.push_back(of_vertex / mass);
    p.inverse_air_mass = p.spread =
        reference::spread_row_sums(c.grid(), c.p.sheet.delta, places, areas, c.p.flow.density)[middle][0];
    const double air_mass = c.p.flow.density * c.p.flow.high[0];
    p.response = 1.0 / air_mass;
    p.stiffness = std::pow(omega_dt / p.dt, 2) * air_mass;
    constexpr double distance = 1.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      fabric::Parameters& cloth = c.p.fabric;
      cloth.mesh.lines.push_back({static_cast<int>(i), static_cast<int>(cloth.mesh.rest.size())});
      cloth.mesh.line_stiffness.push_back(areas[i] * p.stiffness * distance);
      cloth.mesh.rest.push_back({places[i][0] - distance, places[i][1], places[i][2]});
      cloth.mass.push_back(1.0);
      cloth.pinned.push_back(7);
      c.v.push_back({});
    }
    c.x = c.p.fabric.mesh.rest;
  }

  CoupledCase c;
  SheetModeParameters p;
};

struct Motion {
  double displacement, velocity;
};

Motion motion_of(const CoupledCase& c, CoupledRun& run, std::size_t vertex) {
  std::vector<Vector> x(run.vertices), v(run.vertices);
  run.solver->fabric().download(x, v);
  return {x[vertex][0] - c.x[vertex][0], v[vertex][0]};
}

TEST(SheetModes, PistonTakesTheStepsOfTheAnalysis) {
  for (const double omega_dt : {0.3, 2.1})
    for (const double alpha : {CoupledCase::alpha, 1e4, closed})
      for (const double filter : {0.0, 0.5, 1.0}) {
        const Piston piston(omega_dt, alpha, filter);
        CoupledRun run(piston.c);
        SheetMode expected;
        expected.velocity = slow;
        double largest = slow;
        for (int step = 0; step < 30; ++step) {
          ASSERT_TRUE(run.advance(1));
          expected = coupled_step(expected, piston.p, step == 0);
          largest = std::max(largest, std::abs(expected.velocity));
          const Motion found = motion_of(piston.c, run, middle);
          EXPECT_NEAR(found.velocity, expected.velocity, 1e-5 * largest)
              << omega_dt << ' ' << alpha << ' ' << filter;
          EXPECT_NEAR(found.displacement, expected.displacement, 1e-5 * largest * piston.p.dt);
        }
      }
}

TEST(SheetModes, PistonGrowsAndDecaysAsTheAnalysisHasIt) {
  struct Setting {
    double omega_dt, alpha, filter;
    bool grows;
  };
  for (const Setting& setting : {Setting{0.5, closed, 0.5, false},
                                 {2.1, CoupledCase::alpha, 0.5, false},
                                 {2.5, closed, 0.2, true},
                                 {2.1, closed, 0.5, true},
                                 {2.1, closed, 1.0, true}}) {
    const Piston piston(setting.omega_dt, setting.alpha, setting.filter);
    const double growth = reference::spectral_radius(amplification(piston.p));
    EXPECT_EQ(growth > 1.001, setting.grows) << growth;
    CoupledRun run(piston.c);
    constexpr int window = 40;
    ASSERT_TRUE(run.advance(window));
    double squares[2] = {};
    for (double& sum : squares)
      for (int step = 0; step < window; ++step) {
        ASSERT_TRUE(run.advance(1));
        const Motion found = motion_of(piston.c, run, middle);
        sum += found.velocity * found.velocity +
               std::pow(setting.omega_dt / piston.p.dt * found.displacement, 2);
      }
    const double measured = std::pow(squares[1] / squares[0], 0.5 / window);
    EXPECT_NEAR(measured, growth, 5e-3) << setting.omega_dt << ' ' << setting.alpha << ' ' << setting.filter;
  }
}

/// Impermeable sheet across 32 by 32 cells that moves as a sine, with its amplitude at rest and its
/// constants.
struct SineSheet {
  static constexpr int cells = 32;

  /// `wave`: length of a period in cells.
  SineSheet(double dt, double filter, int wave = cells, double leak_filter = 0.0)
      : c(drogue::testing::taut_strip(cells, cells, h, dt, wave)),
        at_rest(c),
        antinode(static_cast<std::size_t>(wave)) {
    set_law(c, closed);
    c.p.sheet.filter = p.filter = filter;
    c.p.sheet.leak_filter = p.leak_filter = leak_filter;
    p.mass = 0.5 * (c.p.fabric.mass[antinode] + c.p.fabric.mass[antinode + 1]) / area();
    p.alpha = closed;
    p.dt = dt;
    p.substeps = c.p.substeps;
    const double k = 2.0 * std::numbers::pi / (wave * h);
    std::vector<double> areas(c.x.size(), area());
    std::vector<Vector> impulses(c.x.size());
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      if (i < 2 || i + 2 >= c.x.size()) areas[i] *= 0.5;
      shape.push_back(std::sin(k * c.x[i][1]));
      impulses[i][0] = areas[i] * shape[i];
    }
    const StaggeredGrid grid = c.grid();
    const auto response_of = [&](const reference::FaceField& field) {
      const std::vector<Vector> at_vertices = reference::interpolate(grid, c.p.sheet.delta, field, c.x);
      double sum = 0.0, norm = 0.0;
      for (std::size_t i = 0; i < c.x.size(); ++i)
        sum += areas[i] * shape[i] * at_vertices[i][0], norm += areas[i] * shape[i] * shape[i];
      return sum / norm / c.p.flow.density;
    };
    reference::FaceField spread = reference::spread(grid, c.p.sheet.delta, c.x, impulses);
    p.spread = response_of(spread);
    flow::Parameters box = c.p.flow;
    for (flow::Boundary& side : box.boundary) side.kind = flow::BoundaryKind::periodic;
    static_cast<void>(reference::project(reference::FlowDomain(box), spread, 1.0));
    p.response = response_of(spread);
    p.inverse_air_mass =
        reference::spread_row_sums(grid, c.p.sheet.delta, c.x, areas, c.p.flow.density)[antinode][0];
    p.smoothing = smoothing(grid);
    for (std::size_t i = 0; i < c.x.size(); ++i) c.x[i][0] += displacement * shape[i];
    CoupledRun run(c);
    std::vector<Vector> forces(c.x.size());
    run.solver->fabric().forces(forces);
    p.stiffness = -0.5 * (forces[antinode][0] + forces[antinode + 1][0]) / (area() * displacement);
  }

  /// Factor of the means along the sheet for the sine.
  [[nodiscard]] double smoothing(const StaggeredGrid& grid) const {
    const mesh::Mesh& mesh = c.p.fabric.mesh;
    const std::vector<double> smoothed =
        reference::smoothed_along(mesh, c.x, shape, smoothing_sweeps(mesh, grid));
    const std::vector<double> each = reference::surface_geometry(mesh, c.x).area;
    double sum = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < shape.size(); ++i)
      sum += each[i] * shape[i] * smoothed[i], norm += each[i] * shape[i] * shape[i];
    return sum / norm;
  }

  /// Amplitude of the sine in the displacements of a run, m.
  [[nodiscard]] double amplitude(CoupledRun& run) const {
    std::vector<Vector> x(run.vertices), v(run.vertices);
    run.solver->fabric().download(x, v);
    double sum = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += shape[i] * (x[i][0] - at_rest.x[i][0]), norm += shape[i] * shape[i];
    return sum / norm;
  }

  /// Half of the area of two vertices beside each other, m^2.
  [[nodiscard]] static double area() { return 0.5 * h * 0.5 * h; }

  static constexpr double displacement = 1e-3;  ///< m
  CoupledCase c, at_rest;
  std::size_t antinode;  ///< first vertex a quarter of a period from an end
  std::vector<double> shape;
  SheetModeParameters p;
};

/// First two zero crossings of a mode that starts at rest with a displacement, in steps.
class Crossings {
 public:
  void add(double displacement) {
    ++_steps;
    if (_found < 2 && displacement * _before < 0.0)
      _at[_found++] = _steps - displacement / (displacement - _before);
    _before = displacement;
  }
  /// Angular frequency times dt. Not before the second crossing.
  [[nodiscard]] double omega_dt() const { return std::numbers::pi / (_at[1] - _at[0]); }
  [[nodiscard]] bool complete() const { return _found == 2; }

 private:
  double _before = SineSheet::displacement, _at[2] = {};
  int _steps = 0, _found = 0;
};

TEST(SheetModes, SineTakesTheStepsOfTheAnalysis) {
  for (const double filter : {0.0, 0.5, 1.0}) {
    const SineSheet sheet(0.002, filter);
    CoupledRun run(sheet.c);
    SheetMode expected;
    expected.displacement = SineSheet::displacement;
    Crossings measured, analysed;
    for (int step = 0; step < 400 && !(measured.complete() && analysed.complete()); ++step) {
      ASSERT_TRUE(run.advance(1));
      expected = coupled_step(expected, sheet.p, step == 0);
      const double found = motion_of(sheet.at_rest, run, sheet.antinode).displacement;
      EXPECT_NEAR(found, expected.displacement, 0.02 * SineSheet::displacement) << filter << ' ' << step;
      measured.add(found);
      analysed.add(expected.displacement);
    }
    ASSERT_TRUE(measured.complete() && analysed.complete());
    EXPECT_NEAR(measured.omega_dt() / analysed.omega_dt(), 1.0, 4e-3) << filter;
    // Added mass and stiffness alone.
    const double exact = sheet.p.dt * std::sqrt(sheet.p.stiffness / (sheet.p.mass + 1.0 / sheet.p.response));
    EXPECT_NEAR(measured.omega_dt() / exact, 1.0, filter == 1.0 ? 5e-3 : 2e-2) << filter;
    EXPECT_GT(exact, 0.03);
  }
}

/// Amplitude of an impermeable sine of eight cells in 60 steps, and that by the analysis with a weight of the
/// defect of its own, m.
struct ShortWave {
  std::vector<double> found, expected;

  ShortWave(double leak_filter, double leak_filter_of_analysis) {
    SineSheet sheet(0.002, 0.5, 8, leak_filter);
    sheet.p.leak_filter = leak_filter_of_analysis;
    CoupledRun run(sheet.c);
    SheetMode mode;
    mode.displacement = SineSheet::displacement;
    for (int step = 0; step < 60; ++step) {
      EXPECT_TRUE(run.advance(1));
      mode = coupled_step(mode, sheet.p, step == 0);
      found.push_back(sheet.amplitude(run));
      expected.push_back(mode.displacement);
    }
  }
  /// Largest difference relative to the amplitude at the start.
  [[nodiscard]] double difference() const {
    double largest = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k)
      largest = std::max(largest, std::abs(found[k] - expected[k]));
    return largest / SineSheet::displacement;
  }
};

TEST(SheetModes, ShortSineTakesTheStepsOfTheAnalysisWithTheSmoothedDefect) {
  // Interpolation after spreading gives this wave 0.86 of the row sum.
  for (const double leak_filter : {0.0, 0.1, 0.5}) {
    EXPECT_LT(ShortWave(leak_filter, leak_filter).difference(), 0.02) << leak_filter;
    const double other = leak_filter > 0.0 ? 0.0 : 0.5;
    EXPECT_GT(ShortWave(leak_filter, other).difference(), 0.04) << leak_filter;
  }
}

}  // namespace
}  // namespace drogue::coupling
