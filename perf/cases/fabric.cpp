#include <algorithm>
#include <memory>
#include <optional>

#include "kernels/fabric/elastic/adjacency.hpp"
#include "kernels/reference/fabric/scatter_step.hpp"
#include "perf/cases/cases.hpp"
#include "perf/models/fabric_step.hpp"
#include "perf/problems/sheet.hpp"

namespace drogue::perf {

namespace {

/// Reference loop on one core that scatters edge forces to vertices, with the time step of the solver.
Case scatter_case(int vertices, long steps) {
  struct Run {
    std::unique_ptr<reference::ScatterSheet> loop;
    fabric::Parameters p;
    sheet::State state;
    double dt = 0.0;
  };
  const auto run = std::make_shared<Run>();
  return {.name = "springs-step/scatter-loop/" + std::to_string(vertices),
          .on_device = false,
          .unit_of_work = "step",
          .bound = "one core; no vectorisation requested",
          .prepare =
              [=] {
                run->p = sheet::parameters(vertices);
                run->loop = std::make_unique<reference::ScatterSheet>(run->p);
                run->dt = sheet::default_dt(run->p, *fabric::create_solver(device::Backend::serial, run->p));
                return Sample{[=] { run->state = sheet::start(run->p); },
                              [=] {
                                for (long step = 0; step < steps; ++step)
                                  run->loop->step(run->dt, run->state.x, run->state.v);
                                return steps;
                              }};
              },
          .error = [=] { return sheet::energy_drift(run->p, run->state); },
          .tolerance = sheet::tolerance(fabric::Integrator::rk4, vertices),
          .facts =
              [=] {
                return Facts{"serial", static_cast<std::int64_t>(run->p.mass.size()), "scatter-loop"};
              }};
}

/// Change of the standard parameters.
struct FabricVariant {
  const char* name;  ///< last part of the case's name
  void (*apply)(fabric::Parameters&);
};

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

Facts sheet_facts(device::Backend backend, const fabric::Parameters& p, const fabric::Solver& solver,
                  const std::string& variant) {
  Facts facts{std::string(device::name(backend)), static_cast<std::int64_t>(p.mass.size()), variant};
  facts.driver = solver.driver();
  if (facts.driver == "persistent") return facts;
  if (p.integrator != fabric::Integrator::rk4) {
    facts.launches = 1;
    return facts;
  }
  const bool stages = !device::needs_device(backend) || p.driver == fabric::Driver::stages;
  facts.launches = stages ? 4 : 2;
  if (device::needs_device(backend) == stages) return facts;  // stages of a device store nothing in slots
  const auto slots = static_cast<std::int64_t>(fabric::ring_adjacency(p.mesh).neighbour.size());
  facts.bytes = fabric_step_bytes(stages ? FabricKernels::stages : FabricKernels::halves, facts.cells, slots);
  return facts;
}

/// Sheet of several cases, made by the first that is prepared.
class SharedSheet {
 public:
  explicit SharedSheet(int vertices) : _vertices(vertices) {}
  const fabric::Parameters& parameters() {
    if (!_parameters) _parameters = sheet::parameters(_vertices);
    return *_parameters;
  }

 private:
  int _vertices;
  std::optional<fabric::Parameters> _parameters;
};

Case sheet_case(device::Backend backend, int vertices, const std::shared_ptr<SharedSheet>& sheet, long steps,
                const FabricVariant& variant) {
  struct Run {
    fabric::Parameters p;
    std::unique_ptr<fabric::Solver> solver;
  };
  const auto run = std::make_shared<Run>();
  const std::string name(device::name(backend));
  fabric::Parameters changed;
  variant.apply(changed);
  return {.name = "springs-step/" + name + "/" + std::to_string(vertices) + (*variant.name ? "/" : "") +
                  variant.name,
          .on_device = device::needs_device(backend),
          .unit_of_work = "step",
          .bound = backend == device::Backend::cuda
                       ? "latency between patches below 100k vertices, memory bandwidth above"
                       : "loads of neighbours by the cores",
          .prepare =
              [=] {
                run->p = sheet->parameters();
                variant.apply(run->p);
                run->solver = fabric::create_solver(backend, run->p);
                return sheet::steps(run->p, *run->solver, steps);
              },
          .error = [=] { return sheet::energy_drift(run->p, *run->solver); },
          .tolerance = sheet::tolerance(changed.integrator, vertices),
          .facts = [=] { return sheet_facts(backend, run->p, *run->solver, variant.name); }};
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
    const auto sheet = std::make_shared<SharedSheet>(vertices);
    for (const device::Backend backend : device::compiled_backends()) {
      if (!device::is_present(backend)) continue;
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
