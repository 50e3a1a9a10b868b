#include <array>
#include <limits>
#include <memory>
#include <string>

#include "kernels/flow/solver.hpp"
#include "perf/cases/cases.hpp"
#include "perf/models/step_bytes.hpp"
#include "perf/problems/pressure_solves.hpp"
#include "perf/problems/streams.hpp"

namespace drogue::perf {

namespace {

using Cells = std::array<int, 3>;
using streams::Sides;

/// Change of the standard parameters.
struct FlowVariant {
  const char* name;  ///< last part of the case's name
  Sides sides;
  void (*apply)(flow::Parameters&);
};

const FlowVariant usual_periodic = {"periodic", Sides::periodic, [](flow::Parameters&) {}};
const FlowVariant usual_tunnel = {"tunnel", Sides::tunnel, [](flow::Parameters&) {}};
const std::vector<FlowVariant> flow_variants = {
    {"periodic/rk3", Sides::periodic, [](flow::Parameters& p) { p.time_scheme = flow::TimeScheme::rk3; }},
    {"periodic/central", Sides::periodic,
     [](flow::Parameters& p) { p.advection = flow::Advection::central; }},
    {"periodic/weno-js", Sides::periodic,
     [](flow::Parameters& p) { p.advection = flow::Advection::weno_js; }},
    {"periodic/crank-nicolson", Sides::periodic,
     [](flow::Parameters& p) { p.diffusion = flow::Diffusion::crank_nicolson; }},
    {"periodic/diagonalization", Sides::periodic,
     [](flow::Parameters& p) { p.pressure_solver = flow::PressureSolver::diagonalization; }},
    {"tunnel/vreman", Sides::tunnel, [](flow::Parameters& p) { p.turbulence = flow::Turbulence::vreman; }}};

/// Steps from an exact solution, after the samples.
constexpr long exact_steps = 8;

/// Largest relative error of these steps: one and a half times the most of all variants on 16 cells along x,
/// or less. The error is of first order in the spacing at least, because the number of steps is fixed and the
/// first one of AB2 is an Euler step. A wrong flux gives an error of order one.
double largest_exact_error(const flow::Parameters& p, Sides sides) {
  return (sides == Sides::periodic ? 0.6 : 1.0) / p.cells[0];
}

Case flow_case(device::Backend backend, const Cells& cells, const FlowVariant& variant, long steps) {
  flow::Parameters p = streams::parameters(cells, variant.sides);
  variant.apply(p);
  return {.name = "flow-step/" + std::string(device::name(backend)) + "/" + streams::text(cells) + "/" +
                  variant.name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = backend == device::Backend::cuda ? "FP64 issue of the momentum stage, memory of the rest"
                                                    : "FP64 issue of the cores",
          .tolerance = streams::divergence_tolerance,
          .prepare =
              [=] {
                const std::shared_ptr<flow::Solver> solver = flow::create_solver(backend, p);
                const auto exact_error = std::make_shared<double>(0.0);
                Sample sample = streams::steps(p, solver, steps);
                // A model of turbulence changes the solution.
                if (p.turbulence == flow::Turbulence::none)
                  sample.error = [=, divergence_of = sample.error] {
                    const double divergence = divergence_of();
                    *exact_error = streams::exact_error(p, *solver, exact_steps);
                    return *exact_error <= largest_exact_error(p, variant.sides)
                               ? divergence
                               : std::numeric_limits<double>::infinity();
                  };
                sample.complete = [=](Facts& facts) {
                  facts.solution_error = *exact_error;
                  facts.driver = solver->driver();
                };
                return sample;
              },
          .facts = {.cells = static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2],
                    .variant = variant.name,
                    .bytes = flow_step_bytes(p)}};
}

void add_pressure_cases(std::vector<Case>& cases, device::Backend backend, const Cells& grid) {
  for (const PressureSolve& solve : pressure_solves(backend, grid, {Sides::periodic, Sides::tunnel}, 1 << 19))
    cases.push_back(pressure_case(solve));
}

}  // namespace

std::vector<Case> flow_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : present_backends()) {
    if (quick) {
      cases.push_back(flow_case(backend, {32, 32, 32}, usual_periodic, 4));
      cases.push_back(flow_case(backend, {20, 20, 40}, usual_tunnel, 4));
      add_pressure_cases(cases, backend, {16, 16, 16});
      continue;
    }
    const bool gpu = backend == device::Backend::cuda;
    const Cells large = gpu ? Cells{256, 256, 256} : Cells{64, 64, 64};
    const long steps = gpu ? 10 : 4;
    cases.push_back(flow_case(backend, large, usual_periodic, steps));
    cases.push_back(flow_case(backend, large, usual_tunnel, steps));
    for (const FlowVariant& variant : flow_variants)
      cases.push_back(flow_case(backend, large, variant, steps));
    // The grid of a parachute, and small ones, where launches dominate.
    cases.push_back(flow_case(backend, {60, 60, 120}, usual_tunnel, gpu ? 200 : 2));
    if (gpu) {
      cases.push_back(flow_case(backend, {64, 64, 64}, usual_periodic, 500));
      cases.push_back(flow_case(backend, {128, 128, 128}, usual_periodic, 100));
      cases.push_back(flow_case(backend, {128, 128, 128}, usual_tunnel, 100));
    }
    for (const Cells& cells : {Cells{64, 64, 64}, Cells{60, 60, 120}, Cells{128, 128, 128}})
      add_pressure_cases(cases, backend, cells);
    if (gpu) add_pressure_cases(cases, backend, {256, 256, 256});
  }
  return cases;
}

}  // namespace drogue::perf
