#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/flow_state.hpp"
#include "tests/support/profiled.hpp"

namespace drogue::testing {

/// Cloth in a box of air that is one cell thick along z, periodic along all axes; strips of cloth across it.
struct CoupledCase {
  static constexpr double alpha = 254.4, beta = 37.6;  ///< MIL-C-7020 type III
  coupling::Parameters p;
  std::vector<fabric::Vector> x, v;

  /// Box of nx by ny cells of h, m, and steps of dt, s.
  CoupledCase(int nx, int ny, double h, double dt) {
    p.flow.cells = {nx, ny, 1};
    p.flow.high = {nx * h, ny * h, h};
    p.flow.density = 1.2;
    p.flow.viscosity = 1.8e-5;
    p.flow.time_scheme = flow::TimeScheme::ab2;
    p.flow.fixed_dt = dt;
    p.sheet.law = {alpha, beta, false};
  }

  [[nodiscard]] double width() const { return p.flow.high[2]; }
  [[nodiscard]] double volume() const { return p.flow.high[0] * p.flow.high[1] * p.flow.high[2]; }

  /// Grid of the references; by default periodic along all axes.
  [[nodiscard]] coupling::StaggeredGrid grid(const std::array<bool, 3>& periodic = {true, true, true}) const {
    coupling::StaggeredGrid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grid.cells[axis] = p.flow.cells[axis];
      grid.spacing[axis] = p.flow.high[axis] / p.flow.cells[axis];
      grid.periodic[axis] = periodic[axis];
    }
    return grid;
  }

  /// Adds a strip of `segments` segments from (x0, y0) to (x1, y1), m, pinned everywhere. Its normal is that
  /// of the segment turned by a right angle clockwise: along x for a strip along y.
  void add_strip(double x0, double y0, double x1, double y1, int segments) {
    fabric::Parameters& cloth = p.fabric;
    const int first = static_cast<int>(cloth.mesh.rest.size());
    for (int k = 0; k <= segments; ++k)
      for (int row = 0; row < 2; ++row) {
        const double part = static_cast<double>(k) / segments;
        cloth.mesh.rest.push_back({x0 + part * (x1 - x0), y0 + part * (y1 - y0), row * width()});
        cloth.pinned.push_back(7);
      }
    for (int k = 0; k < segments; ++k) {
      const int a = first + 2 * k;
      // Alternating diagonals, so that inner vertices have equal areas but for round-off.
      if (k % 2 == 0) {
        cloth.mesh.triangles.push_back({a, a + 2, a + 1});
        cloth.mesh.triangles.push_back({a + 2, a + 3, a + 1});
      } else {
        cloth.mesh.triangles.push_back({a, a + 2, a + 3});
        cloth.mesh.triangles.push_back({a, a + 3, a + 1});
      }
    }
    set_mass(0.0373);
    x = cloth.mesh.rest;
    v.assign(x.size(), fabric::Vector{});
  }

  /// Sets the mass of the cloth per area, kg/m^2.
  void set_mass(double areal) {
    p.fabric.mass = fabric::lumped_masses(p.fabric.mesh, areal, 0.0, fabric::Lumping::area);
  }

  /// Normal velocity at which the law gives the pressure difference dp, Pa, m/s.
  [[nodiscard]] static double law_velocity(double dp) {
    return (-alpha + std::sqrt(alpha * alpha + 4.0 * beta * dp)) / (2.0 * beta);
  }

  /// Solver on a backend at the start of the case.
  [[nodiscard]] std::unique_ptr<coupling::Solver> solver(device::Backend backend) const {
    auto solver = coupling::create_solver(backend, p);
    solver->fabric().upload(x, v);
    solver->start();
    return solver;
  }
};

/// Strip along y across the whole box, under the tension of a strain of one tenth. Its ends and the vertices
/// of every period of `wave` cells are pinned; all others move along x alone.
inline CoupledCase taut_strip(int nx, int ny, double spacing, double dt, int wave) {
  CoupledCase c(nx, ny, spacing, dt);
  const double middle = 0.5 * nx * spacing + 0.013;
  c.add_strip(middle, 0.0, middle, ny * spacing, 2 * ny);
  fabric::Parameters& cloth = c.p.fabric;
  cloth.material.model = fabric::Model::biquadratic;
  cloth.material.membrane_modulus = 2000.0;
  for (std::size_t i = 0; i < cloth.mesh.rest.size(); ++i) {
    const bool is_node = static_cast<int>(i / 2) % wave == 0;
    cloth.pinned[i] = is_node ? 7 : 6;
    cloth.mesh.rest[i][1] /= 1.1;
  }
  c.set_mass(0.0373 * 1.1);
  c.p.substeps = static_cast<int>(std::ceil(dt * 1e3 / spacing));
  return c;
}

/// State of cloth and of the air beside it on the host, by the list of its solver.
struct ClothState {
  std::map<std::string, std::vector<double>> arrays;  ///< by their names
  std::vector<double> force;                          ///< of the vertices on the air, N
  coupling::Progress progress;
};

inline ClothState cloth_state(coupling::Solver& solver) {
  ClothState state{{}, {}, solver.progress()};
  const auto read = [&](const std::string& name, std::size_t size, std::vector<double>& values) {
    values.resize(size);
    solver.download(name, values);
  };
  std::size_t numbers = 0;
  for (const stepping::StateArray& array : solver.state()) {
    read(array.name, array.size(), state.arrays[array.name]);
    if (array.name == "sheet_position") numbers = array.size();
  }
  read("sheet_force", numbers, state.force);
  return state;
}

/// Restores it, after the arrays of the flow.
inline void restore_cloth(coupling::Solver& solver, const ClothState& state) {
  for (const auto& [name, values] : state.arrays) solver.upload(name, values);
  solver.restore(state.progress);
}

/// State of cloth and flow on the host.
struct CoupledState : ClothState {
  std::vector<std::vector<double>> flow;  ///< arrays of `flow::Solver::state`
};

inline CoupledState coupled_state(coupling::Solver& solver) {
  CoupledState state{cloth_state(solver), {}};
  for (const stepping::StateArray& array : solver.flow().state())
    state.flow.push_back(download(solver.flow(), array.name));
  return state;
}

inline void restore(const CoupledState& state, coupling::Solver& solver) {
  std::size_t k = 0;
  for (const stepping::StateArray& array : solver.flow().state())
    solver.flow().upload(array.name, state.flow[k++]);
  restore_cloth(solver, state);
}

/// A case on the backend of the test program.
struct CoupledRun {
  explicit CoupledRun(const CoupledCase& of) : vertices(of.x.size()), solver(of.solver(tested_backend)) {}

  /// Takes steps of the flow; false after a failure.
  bool advance(std::int64_t steps) {
    const std::int64_t end = solver->progress().flow.step + steps;
    return solver->advance(1e9, end, {}) == flow::Stop::pause && solver->progress().flow.step == end;
  }

  /// Sum of the forces of the sheet on the air in the last step, N.
  [[nodiscard]] fabric::Vector force() const {
    std::vector<fabric::Vector> each(vertices);
    solver->download("sheet_force", coupling::numbers(each));
    fabric::Vector sum{};
    for (const fabric::Vector& of_vertex : each)
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += of_vertex[axis];
    return sum;
  }

  std::size_t vertices;
  std::unique_ptr<coupling::Solver> solver;
};

/// Largest difference, in SI units, that states and forces of tens of steps on two backends may have: steps
/// let that of roundings grow.
#if defined(DROGUE_EXACT)
inline constexpr double run_tolerance = 0.0;
#else
inline constexpr double run_tolerance = 1e-10;
#endif

/// Fences, allocations, copies and kernel launches of some steps of the flow.
inline std::array<std::int64_t, 4> counted_steps(CoupledRun& run, std::int64_t steps) {
  const device::ProfilingCounters before = profiled();
  EXPECT_TRUE(run.advance(steps));
  const device::ProfilingCounters after = profiled();
  return {after.fences - before.fences, after.allocations - before.allocations, after.copies - before.copies,
          after.kernel_launches - before.kernel_launches};
}

}  // namespace drogue::testing
