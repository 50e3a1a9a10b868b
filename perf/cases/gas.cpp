#include <algorithm>
#include <memory>

#include "kernels/gas/solver.hpp"
#include "kernels/reference/gas/dense_step.hpp"
#include "perf/cases/cases.hpp"
#include "perf/models/gas_step.hpp"
#include "perf/problems/sod.hpp"

namespace drogue::perf {

namespace {

Case dense_case(std::int64_t cells, long steps) {
  struct Run {
    std::vector<reference::Conserved> state;
    reference::DenseWorkspace workspace;
    double time = 0.0;
  };
  const gas::Parameters p = sod::parameters(cells);
  const double dx = (p.x_max - p.x_min) / static_cast<double>(cells);
  return {.name = "gas-step/dense-loop/" + std::to_string(cells),
          .backend = device::Backend::serial,
          .unit_of_work = "step",
          .bound = "one core; no vectorisation requested",
          .tolerance = sod::tolerance(p),
          .prepare =
              [=] {
                const auto run = std::make_shared<Run>();
                return Sample{[=] {
                                run->time = 0.0;
                                run->state.clear();
                                for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i)
                                  run->state.push_back(
                                      reference::to_conserved(sod::initial(sod::centre(p, i)), p.gamma));
                              },
                              [=] {
                                for (long step = 0; step < steps; ++step)
                                  run->time +=
                                      reference::dense_step(run->state, run->workspace, p.gamma, dx, p.cfl);
                                return steps;
                              },
                              [=] {
                                std::vector<double> rho;
                                for (const auto& u : run->state) rho.push_back(u[0]);
                                return sod::l1_error(p, rho, run->time);
                              }};
              },
          .facts = {.cells = cells, .variant = "dense-loop"}};
}

using GasVariant = Variant<gas::Parameters>;

/// Variants of the largest mesh, where arithmetic dominates, and of a small one, where launches dominate.
const std::vector<GasVariant> large_variants = {
    {"z", [](gas::Parameters& p) { p.weno = gas::Weno::z; }},
    {"teno5", [](gas::Parameters& p) { p.weno = gas::Weno::teno5; }},
    {"split", [](gas::Parameters& p) { p.precision = gas::Precision::split; }},
    {"auto", [](gas::Parameters& p) { p.positivity = gas::Positivity::automatic; }},
    {"on", [](gas::Parameters& p) { p.positivity = gas::Positivity::on; }},
    {"stages", [](gas::Parameters& p) { p.driver = gas::Driver::stages; }}};
const std::vector<GasVariant> small_variants = {
    {"plain", [](gas::Parameters& p) { p.driver = gas::Driver::plain; }},
    {"graph", [](gas::Parameters& p) { p.driver = gas::Driver::graph; }},
    {"stages", [](gas::Parameters& p) { p.driver = gas::Driver::stages; }},
    {"split", [](gas::Parameters& p) { p.precision = gas::Precision::split; }}};

Case solver_case(device::Backend backend, std::int64_t cells, long steps, const GasVariant& variant) {
  gas::Parameters p = sod::parameters(cells);
  variant.apply(p);
  return {.name = "gas-step/" + std::string(device::name(backend)) + "/" + std::to_string(cells) +
                  (*variant.name ? "/" : "") + variant.name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = backend == device::Backend::cuda ? "launch latency below 100k cells, FP64 issue above"
                                                    : "FP64 issue of the cores",
          .tolerance = sod::tolerance(p),
          .prepare =
              [=] {
                const std::shared_ptr<gas::Solver> solver = gas::create_solver(backend, p);
                Sample sample = sod::steps(p, backend, solver, steps);
                sample.complete = [=](Facts& facts) {
                  const StepWork work = step_work(p, solver->tiling());
                  facts.flops = static_cast<double>(work.arithmetic.flops());
                  facts.bytes = static_cast<double>(work.bytes);
                  facts.instructions = static_cast<double>(work.arithmetic.instructions());
                  facts.driver = solver->driver();
                  // The kernels of the stages, and the one that accepts the step.
                  if (facts.driver != "persistent")
                    facts.launches =
                        (solver->tiling().fused ? 1 : gas::stage_table(p.time_scheme).stages) + 1;
                };
                return sample;
              },
          .facts = {.cells = cells, .variant = variant.name}};
}

/// The scheme of [Shi], which copies the state to and from the device in each stage.
Case baseline_step_case(device::Backend backend, std::int64_t cells) {
  Case step = sod::baseline_case(
      "gas-step/" + std::string(device::name(backend)) + "/" + std::to_string(cells) + "/seed",
      "copies between host and device", backend, sod::parameters(cells));
  step.facts = {.cells = cells, .variant = "seed"};
  return step;
}

}  // namespace

std::vector<Case> gas_cases(bool quick) {
  std::vector<Case> cases;
  for (const std::int64_t cells : quick ? std::vector<std::int64_t>{1024, 8192}
                                        : std::vector<std::int64_t>{1024, 8192, 65536, 1 << 20, 1 << 24}) {
    for (const device::Backend backend : present_backends()) {
      const bool gpu = backend == device::Backend::cuda;
      if (!gpu && cells > 1 << 20) continue;
      // A sample takes about 20 ms: enough steps to hide its start and end, and few enough that the waves
      // stay inside the domain, where the exact solution holds.
      const long n = static_cast<long>(cells);
      const long steps =
          gpu ? std::clamp(n / 2, 10L, std::max(10L, 2000L / (1 + n / 65536))) : std::max(4L, 200'000L / n);
      cases.push_back(solver_case(backend, cells, steps, {"", [](gas::Parameters&) {}}));
      if (gpu && cells == 8192)
        for (const GasVariant& variant : small_variants)
          cases.push_back(solver_case(backend, cells, steps, variant));
      if (gpu && cells == 8192) cases.push_back(baseline_step_case(backend, cells));
      if (gpu && cells == 1 << 24)
        for (const GasVariant& variant : large_variants)
          cases.push_back(solver_case(backend, cells, steps, variant));
    }
    if (cells <= 8192) cases.push_back(dense_case(cells, std::max(2L, 50'000L / static_cast<long>(cells))));
  }
  return cases;
}

}  // namespace drogue::perf
