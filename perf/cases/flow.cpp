#include <algorithm>
#include <memory>

#include "perf/cases/cases.hpp"
#include "perf/models/flow_step.hpp"
#include "perf/problems/flow_box.hpp"

namespace drogue::perf {

namespace {

/// Change of the standard parameters: AB2, WENO-Z, explicit diffusion, the faster direct pressure solver.
struct FlowVariant {
  const char* name;  ///< last part of the case's name
  void (*apply)(flow::Parameters&);
};

const FlowVariant flow_standard = {"", [](flow::Parameters&) {}};
const FlowVariant flow_rk3 = {"rk3", [](flow::Parameters& p) { p.time_scheme = flow::TimeScheme::rk3; }};
const FlowVariant flow_js = {"js", [](flow::Parameters& p) { p.advection = flow::Advection::weno_js; }};
const FlowVariant flow_central = {"central",
                                  [](flow::Parameters& p) { p.advection = flow::Advection::central; }};
const FlowVariant flow_crank_nicolson = {
    "crank-nicolson", [](flow::Parameters& p) { p.diffusion = flow::Diffusion::crank_nicolson; }};
const FlowVariant flow_plain = {"plain", [](flow::Parameters& p) { p.driver = flow::Driver::plain; }};

/// Benchmark problem with a grid.
struct FlowBox {
  const char* name;  ///< of the conditions on the sides, in the case's name
  flow::Parameters parameters;
};

FlowBox periodic_box(int nx, int ny, int nz) { return {"periodic", flow_box::periodic({nx, ny, nz})}; }
FlowBox through_box(int nx, int ny, int nz) { return {"through", flow_box::through({nx, ny, nz})}; }

Case flow_case(device::Backend backend, FlowBox box, const FlowVariant& variant) {
  variant.apply(box.parameters);
  const flow::Parameters p = box.parameters;
  const std::int64_t cells = flow_box::cell_count(p);
  const bool gpu = backend == device::Backend::cuda;
  // A sample takes about 20 ms on a GPU and less than a second on a core. The vortices keep their shape.
  const long n = static_cast<long>(cells);
  const long steps = gpu ? std::clamp(100'000'000L / n, 8L, 100L) : std::max(2L, 1'000'000L / n);
  const auto solver = std::make_shared<std::unique_ptr<flow::Solver>>();
  const std::string name(device::name(backend));
  const std::string label =
      flow_box::grid_name(p) + "/" + box.name + (*variant.name ? "/" : "") + variant.name;
  return {"flow-step/" + name + "/" + label,
          "step",
          !gpu              ? "FP64 issue of the cores"
          : cells < 1 << 20 ? "latency of kernels"
                            : "memory bandwidth",
          [=] {
            *solver = flow::create_solver(backend, p);
            return flow_box::steps(p, **solver, steps);
          },
          [=] { return flow_box::divergence(p, **solver); },
          flow_box::tolerance,
          [=] {
            return Facts{name, cells, label, 0.0, flow_step_bytes(p)};
          }};
}

/// Cases of a backend: a box and the variants that are measured in it.
struct FlowCases {
  FlowBox box;
  std::vector<FlowVariant> variants;
};

std::vector<FlowCases> flow_cases_of(bool gpu, bool quick) {
  if (quick)
    return {{periodic_box(32, 32, 32), {flow_standard, flow_rk3, flow_central, flow_crank_nicolson}},
            {through_box(20, 20, 40), {flow_standard}}};
  if (!gpu)
    return {{periodic_box(64, 64, 64), {flow_standard, flow_rk3, flow_js, flow_central, flow_crank_nicolson}},
            {through_box(64, 64, 64), {flow_standard}},
            {through_box(60, 60, 120), {flow_standard}}};
  return {
      {periodic_box(64, 64, 64), {flow_standard, flow_plain}},
      {periodic_box(128, 128, 128), {flow_standard}},
      {periodic_box(256, 256, 256), {flow_standard, flow_rk3, flow_js, flow_central, flow_crank_nicolson}},
      {through_box(256, 256, 256), {flow_standard}},
      {through_box(60, 60, 120), {flow_standard, flow_rk3, flow_crank_nicolson, flow_plain}}};
}

}  // namespace

std::vector<Case> flow_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    for (const FlowCases& of_box : flow_cases_of(backend == device::Backend::cuda, quick))
      for (const FlowVariant& variant : of_box.variants)
        cases.push_back(flow_case(backend, of_box.box, variant));
  }
  return cases;
}

}  // namespace drogue::perf
