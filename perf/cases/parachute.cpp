#include <memory>
#include <string>

#include "kernels/device/backend.hpp"
#include "perf/cases/cases.hpp"
#include "perf/problems/inflation.hpp"
#include "perf/problems/streams.hpp"

namespace drogue::perf {

namespace {

Case inflation_case(device::Backend backend, const std::array<int, 3>& cells, bool with_contact, double lead,
                    long milliseconds) {
  const std::string name(device::name(backend)), variant = with_contact ? "c9-contact" : "c9";
  const auto solver = std::make_shared<std::unique_ptr<coupling::Solver>>();
  const auto problem = std::make_shared<inflation::Problem>();
  return {.name = "parachute-flight/" + name + "/" + streams::text(cells) + "/" + variant,
          .on_device = device::needs_device(backend),
          .unit_of_work = "ms of flight",
          .bound = device::needs_device(backend) ? "latency of the steps of the cloth"
                                                 : "FP64 issue of the cores, for cells and triangles",
          .prepare =
              [=] {
                *problem = inflation::problem({.cells = cells, .with_contact = with_contact});
                *solver = coupling::create_solver(backend, problem->parameters);
                return inflation::flight(*problem, **solver, lead, milliseconds);
              },
          .error = [=] { return inflation::imbalance(problem->parameters, **solver); },
          .tolerance = 1e-12,
          .facts =
              [=] {
                return Facts{name, static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2], variant};
              }};
}

}  // namespace

std::vector<Case> parachute_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    const auto add = [&](const std::array<int, 3>& cells, bool with_contact, double lead, long milliseconds) {
      cases.push_back(inflation_case(backend, cells, with_contact, lead, milliseconds));
    };
    if (quick) {
      add({12, 12, 24}, false, 0.02, 10);
    } else if (device::needs_device(backend)) {
      add({60, 60, 120}, false, 0.8, 40);
      add({60, 60, 120}, true, 0.8, 40);
      add({120, 120, 240}, false, 0.8, 20);
    } else {
      add({40, 40, 80}, false, 0.2, 10);
    }
  }
  return cases;
}

}  // namespace drogue::perf
