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
  const std::string variant = with_contact ? "c9-contact" : "c9";
  return {.name = "parachute-flight/" + std::string(device::name(backend)) + "/" + streams::text(cells) +
                  "/" + variant,
          .backend = backend,
          .unit_of_work = "ms of flight",
          .bound = device::needs_device(backend) ? "latency of the steps of the cloth"
                                                 : "FP64 issue of the cores, for cells and triangles",
          .tolerance = inflation::largest_imbalance,
          .prepare =
              [=] {
                return inflation::flight(backend,
                                         inflation::problem({.cells = cells, .with_contact = with_contact}),
                                         lead, milliseconds);
              },
          .facts = {.cells = static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2], .variant = variant}};
}

}  // namespace

std::vector<Case> parachute_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : present_backends()) {
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
