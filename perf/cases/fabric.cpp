#include <algorithm>
#include <memory>

#include "kernels/fabric/elastic/adjacency.hpp"
#include "kernels/reference/fabric/scatter_step.hpp"
#include "perf/cases/cases.hpp"
#include "perf/models/step_bytes.hpp"
#include "perf/problems/sheet.hpp"

namespace drogue::perf {

namespace {

/// Reference loop on one core that scatters edge forces to vertices, with the time step of the solver.
Case scatter_case(int vertices, long steps) {
  return {
      .name = "springs-step/scatter-loop/" + std::to_string(vertices),
      .backend = device::Backend::serial,
      .unit_of_work = "step",
      .bound = "one core; no vectorisation requested",
      .tolerance = sheet::tolerance(fabric::Integrator::rk4, vertices),
      .prepare =
          [=] {
            const auto p = std::make_shared<const fabric::Parameters>(sheet::parameters(vertices));
            const auto loop = std::make_shared<reference::ScatterSheet>(*p);
            const auto state = std::make_shared<sheet::State>();
            const double dt = sheet::default_dt(*p, *fabric::create_solver(device::Backend::serial, *p));
            return Sample{
                .reset = [=] { *state = sheet::start(*p); },
                .work =
                    [=] {
                      for (long step = 0; step < steps; ++step) loop->step(dt, state->x, state->v);
                      return steps;
                    },
                .error = [=] { return sheet::energy_drift(*p, *state); },
                .complete = [=](Facts& facts) { facts.cells = static_cast<std::int64_t>(p->mass.size()); }};
          },
      .facts = {.variant = "scatter-loop"}};
}

using FabricVariant = Variant<fabric::Parameters>;

const FabricVariant standard = {"", [](fabric::Parameters&) {}};
const FabricVariant quadratic = {"quadratic",
                                 [](fabric::Parameters& p) { p.material.model = fabric::Model::quadratic; }};
const FabricVariant verlet = {"verlet",
                              [](fabric::Parameters& p) { p.integrator = fabric::Integrator::verlet; }};
const FabricVariant slack = {"tension-only", [](fabric::Parameters& p) { p.material.tension_only = true; }};
const FabricVariant graph = {"graph", [](fabric::Parameters& p) { p.driver = fabric::Driver::graph; }};
const FabricVariant plain = {"plain", [](fabric::Parameters& p) { p.driver = fabric::Driver::plain; }};
const FabricVariant patch_64 = {"patch-64", [](fabric::Parameters& p) { p.patch = 64; }};
const FabricVariant patch_128 = {"patch-128", [](fabric::Parameters& p) { p.patch = 128; }};
const FabricVariant patch_256 = {"patch-256", [](fabric::Parameters& p) { p.patch = 256; }};

void complete(Facts& facts, device::Backend backend, const fabric::Parameters& p,
              const fabric::Solver& solver) {
  facts.cells = static_cast<std::int64_t>(p.mass.size());
  facts.driver = solver.driver();
  if (facts.driver == "persistent") return;
  if (p.integrator != fabric::Integrator::rk4) {
    facts.launches = 1;
    return;
  }
  const bool stages = !device::needs_device(backend) || p.driver == fabric::Driver::stages;
  facts.launches = stages ? 4 : 2;
  if (device::needs_device(backend) == stages) return;  // stages of a device store nothing in slots
  const auto slots = static_cast<std::int64_t>(fabric::ring_adjacency(p.mesh).neighbour.size());
  facts.bytes = fabric_step_bytes(stages ? FabricKernels::stages : FabricKernels::halves, facts.cells, slots);
}

/// `sheet`: that of several cases, made by the first that is prepared.
Case sheet_case(device::Backend backend, int vertices, const std::shared_ptr<fabric::Parameters>& sheet,
                long steps, const FabricVariant& variant) {
  fabric::Parameters changed;
  variant.apply(changed);
  return {.name = "springs-step/" + std::string(device::name(backend)) + "/" + std::to_string(vertices) +
                  (*variant.name ? "/" : "") + variant.name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = backend == device::Backend::cuda
                       ? "latency between patches below 100k vertices, memory bandwidth above"
                       : "loads of neighbours by the cores",
          .tolerance = sheet::tolerance(changed.integrator, vertices),
          .prepare =
              [=] {
                if (sheet->mass.empty()) *sheet = sheet::parameters(vertices);
                const auto p = std::make_shared<fabric::Parameters>(*sheet);
                variant.apply(*p);
                const std::shared_ptr<fabric::Solver> solver = fabric::create_solver(backend, *p);
                Sample sample = sheet::steps(p, solver, steps);
                sample.complete = [=](Facts& facts) { complete(facts, backend, *p, *solver); };
                return sample;
              },
          .facts = {.variant = variant.name}};
}

std::vector<FabricVariant> variants_of(int vertices, bool gpu) {
  if (!gpu) return vertices < 100'000 ? std::vector{standard, quadratic, verlet} : std::vector{standard};
  if (vertices < 10'000) return {standard, graph, plain, patch_64, patch_128, quadratic, verlet};
  if (vertices < 100'000) return {standard, graph, patch_128, patch_256, quadratic, verlet};
  if (vertices < 1'000'000) return {standard, graph, quadratic, verlet};
  return {standard, quadratic, slack, verlet};
}

}  // namespace

std::vector<Case> fabric_cases(bool quick) {
  std::vector<Case> cases;
  for (const int vertices : quick ? std::vector{2640} : std::vector{2640, 15'625, 100'000, 1'000'000}) {
    const auto sheet = std::make_shared<fabric::Parameters>();
    for (const device::Backend backend : present_backends()) {
      const bool gpu = backend == device::Backend::cuda;
      if (!gpu && vertices > 100'000) continue;
      // A sample takes about 20 ms: enough steps to hide its start and end.
      const long steps =
          gpu ? std::clamp(80'000'000L / vertices, 80L, 4096L) : std::max(4L, 150'000L / vertices);
      for (const FabricVariant& variant : variants_of(vertices, gpu))
        cases.push_back(sheet_case(backend, vertices, sheet, steps, variant));
    }
    if (vertices < 100'000) cases.push_back(scatter_case(vertices, std::max(4L, 50'000L / vertices)));
  }
  return cases;
}

}  // namespace drogue::perf
