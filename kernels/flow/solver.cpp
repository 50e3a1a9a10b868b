#include "kernels/flow/solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/device/allocate.hpp"
#include "kernels/device/block_size.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/diffusive_step.hpp"
#include "kernels/flow/make_grid.hpp"
#include "kernels/flow/step_constants.hpp"

namespace drogue::flow {

// Solver on an execution-space instance of its own: instances/solver.cpp, for each backend.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters, const linear::RankGroup& group);

namespace {

void require(bool holds, const std::string& condition) {
  if (!holds) throw std::invalid_argument("flow solver: " + condition);
}

bool is_prescribed(BoundaryKind kind) { return kind == BoundaryKind::wall || kind == BoundaryKind::inflow; }

void check_faces(const Parameters& p, std::size_t axis) {
  const std::vector<double>& faces = p.faces[axis];
  if (faces.empty()) return;
  require(faces.size() == static_cast<std::size_t>(p.cells[axis]) + 1 && p.cells[axis] > 1,
          "an axis with faces has one more of them than cells, and more than one cell");
  require(faces.front() == p.low[axis] && faces.back() == p.high[axis],
          "the first and last face of an axis are the ends of the domain");
  require(std::ranges::adjacent_find(faces, [](double a, double b) { return !(a < b); }) == faces.end(),
          "the faces of an axis must ascend");
}

/// Checks that the prescribed inflow can leave. Expressions are not evaluated.
void check_net_inflow(const Parameters& p) {
  double inflow = 0.0, magnitude = 0.0;
  for (std::size_t side = 0; side < 6; ++side) {
    const Boundary& boundary = p.boundary[side];
    if (boundary.kind == BoundaryKind::outflow || !boundary.velocity_expressions.empty()) return;
    if (!is_prescribed(boundary.kind)) continue;
    const std::size_t axis = side / 2;
    double area = 1.0;
    for (std::size_t a = 0; a < 3; ++a)
      if (a != axis) area *= p.high[a] - p.low[a];
    const double flow = (side % 2 == 0 ? 1.0 : -1.0) * boundary.velocity[axis] * area;
    inflow += flow;
    magnitude += std::abs(flow);
  }
  require(std::abs(inflow) <= 1e-12 * magnitude,
          "the prescribed velocities have a net inflow, but no side is an outflow");
}

}  // namespace

std::array<int, 3> extents(const Parameters& p, std::size_t normal) {
  std::array<int, 3> shape = p.cells;
  if (normal != at_cells && p.cells[normal] > 1 && p.boundary[2 * normal].kind != BoundaryKind::periodic)
    ++shape[normal];
  return shape;
}

double largest_diffusive_dt(const Parameters& p) {
  return diffusive_reserve * step_constants(p, make_grid(p)).diffusive_dt;
}

const char* failure_text(FailureReason reason) {
  switch (reason) {
    case FailureReason::not_finite:
      return "the velocity is not finite";
    case FailureReason::side_velocity:
      return "the prescribed velocity is not finite";
    case FailureReason::time_step:
      return "no time step is admissible";
    case FailureReason::pressure_solver:
      return "the pressure solver did not converge";
    case FailureReason::net_inflow:
      return "the prescribed velocities have a net inflow, but no side is an outflow";
  }
  return "";
}

void check_parameters(const Parameters& p) {
  constexpr int most_cells = 1 << 14;
  double cells = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int n = p.cells[axis];
    require(n == 1 || (n >= 4 && n <= most_cells), "an axis must have 1 cell, or 4 to 16384");
    require(std::isfinite(p.low[axis]) && std::isfinite(p.high[axis]) && p.low[axis] < p.high[axis],
            "the domain must not be empty");
    check_faces(p, axis);
    const BoundaryKind low = p.boundary[2 * axis].kind, high = p.boundary[2 * axis + 1].kind;
    require((low == BoundaryKind::periodic) == (high == BoundaryKind::periodic),
            "both sides of an axis must be periodic, or none");
    require(low != BoundaryKind::neighbour && high != BoundaryKind::neighbour,
            "a side of the domain has no neighbour");
    require(n > 1 || low == BoundaryKind::periodic || low == BoundaryKind::slip,
            "an axis with one cell must be periodic or have slip sides");
    for (const Boundary& side : p.boundary)
      require(
          n > 1 || low == BoundaryKind::periodic || !is_prescribed(side.kind) || side.velocity[axis] == 0.0,
          "sides with a velocity through the slip sides of an axis with one cell have no solution");
    require(n > 1 || low == BoundaryKind::periodic || p.body_force[axis] == 0.0,
            "a body force along an axis with one cell needs periodic sides");
    require(p.pressure_drop[axis] == 0.0 || low == BoundaryKind::periodic,
            "a pressure drop needs a periodic axis");
    cells *= n;
  }
  require(cells > 1.0 && cells < 2e9, "the grid must have more than 1 cell, and fewer than 2 billion");
  require(std::isfinite(p.density) && p.density > 0.0, "the density must be positive");
  require(std::isfinite(p.viscosity) && p.viscosity >= 0.0, "the viscosity must not be negative");
  require(p.fixed_dt > 0.0 || p.cfl >= 0.0, "cfl must not be negative");
  require(p.fixed_dt > 0.0 || p.cfl <= stable_cfl(p.time_scheme),
          "cfl must be at most 1.4 with the time scheme RK3, 0.7 with AB2");
  require(p.diffusion == Diffusion::explicit_ || p.time_scheme == TimeScheme::ab2,
          "Crank-Nicolson diffusion needs the time scheme AB2");
  require(p.pressure_solver != PressureSolver::fft ||
              std::ranges::all_of(p.faces, [](const std::vector<double>& faces) { return faces.empty(); }),
          "fast transforms need axes without faces, whose cells have one width");
#if !defined(DROGUE_HAVE_HYPRE)
  require(p.pressure_solver != PressureSolver::hypre_pfmg, "this build lacks hypre");
#endif
  require(p.pressure_tolerance > 0.0 && p.pressure_tolerance < 1.0,
          "pressure_tolerance must lie between 0 and 1");
  for (const Boundary& side : p.boundary) {
    require(side.velocity_expressions.empty() ||
                (side.velocity_expressions.size() == 3 && is_prescribed(side.kind)),
            "a wall or inflow has three velocity expressions, or none; other sides have none");
    for (const double v : side.velocity) require(std::isfinite(v), "the velocity of a side must be finite");
  }
  require(p.fixed_dt > 0.0 || p.max_dt > 0.0 || p.horizon > 0.0 || !change_in_time(p.boundary),
          "sides that change in time need a horizon, a dt or a largest one");
  require(device::is_block_size(p.block), "block must be a multiple of 32 between 32 and 512");
  check_net_inflow(p);
}

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters,
                                      const linear::RankGroup& group) {
  check_parameters(parameters);
  return device::allocate([&] {
    return device::dispatch(
        backend, [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(parameters, group); });
  });
}

}  // namespace drogue::flow
