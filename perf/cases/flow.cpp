#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "kernels/flow/solver.hpp"
#include "kernels/reference/linear/laplacian.hpp"
#include "perf/cases/cases.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"

namespace drogue::perf {

namespace {

using Cells = std::array<int, 3>;
using streams::Sides;

std::string text(const Cells& cells) {
  return std::to_string(cells[0]) + "x" + std::to_string(cells[1]) + "x" + std::to_string(cells[2]);
}
std::int64_t count(const Cells& cells) { return static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2]; }

/// Change of the standard parameters.
struct Variant {
  const char* name;  ///< last part of the case's name
  Sides sides;
  void (*apply)(flow::Parameters&);
  /// Numbers that a step reads and writes at the least, per cell: velocity in, prediction out, old rate in
  /// and out; prediction in, divergence out; two passes of the pressure solver at the least; prediction and
  /// pressure in, velocity out.
  double numbers = 4 * 3 + 3 + 1 + 4 + 3 + 1 + 3;
};

const Variant periodic = {"periodic", Sides::periodic, [](flow::Parameters&) {}};
const Variant tunnel = {"tunnel", Sides::tunnel, [](flow::Parameters&) {}};
const std::vector<Variant> variants = {
    {"periodic/rk3", Sides::periodic, [](flow::Parameters& p) { p.time_scheme = flow::TimeScheme::rk3; },
     3 * (3 * 3 + 3 + 1 + 4 + 3 + 1 + 3)},
    {"periodic/central", Sides::periodic,
     [](flow::Parameters& p) { p.advection = flow::Advection::central; }},
    {"periodic/weno-js", Sides::periodic,
     [](flow::Parameters& p) { p.advection = flow::Advection::weno_js; }},
    {"periodic/crank-nicolson", Sides::periodic,
     [](flow::Parameters& p) { p.diffusion = flow::Diffusion::crank_nicolson; }, 27 + 3 * (5 + 1 + 4 + 3)},
    {"periodic/diagonalization", Sides::periodic,
     [](flow::Parameters& p) { p.pressure_solver = flow::PressureSolver::diagonalization; }},
    {"tunnel/vreman", Sides::tunnel, [](flow::Parameters& p) { p.turbulence = flow::Turbulence::vreman; },
     27 + 3 + 1 + 3 + 1 + 3 + 3}};

Case step_case(device::Backend backend, const Cells& cells, const Variant& variant, long steps) {
  flow::Parameters p = streams::parameters(cells, variant.sides);
  variant.apply(p);
  const auto solver = std::make_shared<std::unique_ptr<flow::Solver>>();
  const std::string name(device::name(backend));
  return {"flow-step/" + name + "/" + text(cells) + "/" + variant.name,
          "step",
          backend == device::Backend::cuda ? "FP64 issue of the momentum stage, memory of the rest"
                                           : "FP64 issue of the cores",
          [=] {
            *solver = flow::create_solver(backend, p);
            return streams::steps(p, **solver, steps);
          },
          [=] { return streams::relative_divergence(p, **solver); },
          1e-12,  // a wrong projection leaves a divergence of order one
          [=] {
            return Facts{name, count(cells), variant.name, 0.0,
                         8.0 * variant.numbers * static_cast<double>(count(cells))};
          }};
}

/// Largest residual over the largest term of the equation, by the Laplacian of the reference.
double residual(const linear::PoissonProblem& problem, const pressure::Solver& solver) {
  reference::CellBox box{problem.cells, problem.spacing, {}};
  double squares = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const linear::AxisConditions& ends = problem.axes[axis];
    const auto end = [&](linear::EndCondition condition) {
      if (ends.periodic) return reference::End::periodic;
      return condition == linear::EndCondition::dirichlet ? reference::End::dirichlet
                                                          : reference::End::neumann;
    };
    box.ends[axis] = {end(ends.low), end(ends.high)};
    squares += 4.0 / (problem.spacing[axis] * problem.spacing[axis]);
  }
  const std::vector<double> p = solver.solution(), image = reference::laplacian(box, p);
  double difference = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    difference = std::max(difference, std::abs(image[i] - solver.right_hand_side()[i]));
    largest = std::max(largest, std::abs(p[i]));
  }
  return difference / (squares * largest);
}

constexpr double iterative_tolerance = 1e-10;

Case pressure_case(device::Backend backend, const Cells& cells, Sides sides, const std::string& method_name,
                   flow::PressureSolver method) {
  const linear::PoissonProblem problem = streams::pressure_problem(cells, sides);
  const bool iterates = method == flow::PressureSolver::hypre_pfmg;
  const long solves = iterates ? 1
                      : backend == device::Backend::cuda
                          ? std::clamp(200'000'000L / static_cast<long>(count(cells)), 5L, 200L)
                          : std::clamp(2'000'000L / static_cast<long>(count(cells)), 1L, 100L);
  const auto solver = std::make_shared<std::unique_ptr<pressure::Solver>>();
  const std::string name(device::name(backend));
  const std::string variant = method_name + (sides == Sides::periodic ? "/periodic" : "/tunnel");
  return {"flow-pressure/" + name + "/" + text(cells) + "/" + variant,
          "solve",
          iterates ? "memory, and copies to the host" : "memory; FP64 tensor cores of matrix products",
          [=] {
            *solver = pressure::create_solver(backend, problem, method, iterative_tolerance);
            return Sample{[] {},
                          [=] {
                            (*solver)->solve(solves);
                            return solves;
                          }};
          },
          [=] { return residual(problem, **solver); },
          iterates ? 1e-7 : 1e-13,
          [=] {
            const int iterations = (*solver)->iterations();
            return Facts{name, count(cells),
                         variant + (iterations > 0 ? "/" + std::to_string(iterations) + " iterations" : "")};
          }};
}

void add_pressure_cases(std::vector<Case>& cases, device::Backend backend, const Cells& cells) {
  const std::pair<const char*, flow::PressureSolver> methods[] = {
      {"fft", flow::PressureSolver::fft},
      {"diagonalization", flow::PressureSolver::diagonalization},
      {"hypre-pfmg", flow::PressureSolver::hypre_pfmg}};
  for (const Sides sides : {Sides::periodic, Sides::tunnel})
    for (const auto& [name, method] : methods) {
      const bool slow = method == flow::PressureSolver::hypre_pfmg && count(cells) > 1 << 22;
      if (slow || !pressure::is_available(backend, streams::pressure_problem(cells, sides), method)) continue;
      cases.push_back(pressure_case(backend, cells, sides, name, method));
    }
}

}  // namespace

std::vector<Case> flow_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    if (quick) {
      cases.push_back(step_case(backend, {32, 32, 32}, periodic, 4));
      cases.push_back(step_case(backend, {20, 20, 40}, tunnel, 4));
      add_pressure_cases(cases, backend, {16, 16, 16});
      continue;
    }
    const bool gpu = backend == device::Backend::cuda;
    const Cells large = gpu ? Cells{256, 256, 256} : Cells{64, 64, 64};
    const long steps = gpu ? 20 : 4;
    cases.push_back(step_case(backend, large, periodic, steps));
    cases.push_back(step_case(backend, large, tunnel, steps));
    for (const Variant& variant : variants) cases.push_back(step_case(backend, large, variant, steps));
    // The grid of a parachute, and small ones, where launches dominate.
    cases.push_back(step_case(backend, {60, 60, 120}, tunnel, gpu ? 200 : 2));
    if (gpu) {
      cases.push_back(step_case(backend, {64, 64, 64}, periodic, 500));
      cases.push_back(step_case(backend, {128, 128, 128}, periodic, 100));
      cases.push_back(step_case(backend, {128, 128, 128}, tunnel, 100));
    }
    for (const Cells& cells : {Cells{64, 64, 64}, Cells{60, 60, 120}, Cells{128, 128, 128}})
      add_pressure_cases(cases, backend, cells);
    if (gpu) add_pressure_cases(cases, backend, {256, 256, 256});
  }
  return cases;
}

}  // namespace drogue::perf
