#include "perf/measurement.hpp"
#include "perf/puts.hpp"

namespace drogue::perf {

namespace {

Case batch_case(device::Backend backend, std::size_t count, int mesh, int steps) {
  const std::string name(device::name(backend)), grid = std::to_string(mesh) + "x" + std::to_string(steps);
  Case batch = puts::batch("options/" + name + "/" + std::to_string(count) + "/" + grid, backend, count,
                           {.mesh = mesh, .steps = steps}, puts::bar);
  batch.facts = [=] { return Facts{name, static_cast<std::int64_t>(count), grid}; };
  return batch;
}

}  // namespace

std::vector<Case> options_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    const bool gpu = backend == device::Backend::cuda;
    const auto add = [&](std::size_t count, int mesh, int steps) {
      cases.push_back(batch_case(backend, count, mesh, steps));
    };
    if (quick) {
      add(16, 64, 16);
      continue;
    }
    add(1, 128, 32);
    add(gpu ? 4096 : 256, 128, 32);
    add(gpu ? 4096 : 256, 256, 64);
    if (gpu) add(1'000'000, 128, 32);
  }
  return cases;
}

}  // namespace drogue::perf
