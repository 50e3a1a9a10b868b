#include <memory>

#include "perf/measurement.hpp"
#include "perf/puts.hpp"

namespace drogue::perf {

namespace {

Case batch_case(device::Backend backend, std::size_t count, int mesh, int steps) {
  struct Run {
    std::vector<options::Contract> contracts;
    std::vector<options::Price> prices;
    std::unique_ptr<options::Pricer> pricer;
    options::Timing timing;
  };
  const auto run = std::make_shared<Run>();
  const std::string name(device::name(backend)), grid = std::to_string(mesh) + "x" + std::to_string(steps);
  return {"options/" + name + "/" + std::to_string(count) + "/" + grid,
          "batch",
          "arithmetic of the convolution",
          [=] {
            run->contracts = puts::distinct(count);
            run->prices.resize(count);
            run->pricer = options::create_pricer(backend, {.mesh = mesh, .steps = steps});
            return Sample{[] {},
                          [=] {
                            run->timing = run->pricer->price(run->contracts, run->prices);
                            return 1L;
                          },
                          [=] { return puts::parts(run->timing); }};
          },
          [=] { return puts::error(run->prices); },
          puts::bar,
          [=] {
            return Facts{name, static_cast<std::int64_t>(count), grid};
          }};
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
