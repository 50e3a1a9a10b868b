#include <memory>

#include "perf/cases/cases.hpp"
#include "perf/ceilings/ceilings.hpp"

namespace drogue::perf {

namespace {

struct CeilingEntry {
  Ceiling ceiling;
  const char *name, *bound;
  double tolerance;  ///< relative; the chains round at every step, the triads are exact
};

constexpr CeilingEntry ceilings[] = {
    {Ceiling::fp64, "fp64", "FP64 multiply-add units", 1e-9},
    {Ceiling::memory, "memory", "memory bandwidth", 0.0},
    {Ceiling::cache, "cache", "bandwidth of the L1 cache, on a GPU of the L2 cache", 0.0}};

Case ceiling_case(device::Backend backend, const CeilingEntry& entry) {
  const auto kernel = std::make_shared<std::unique_ptr<CeilingKernel>>();
  const std::string name(device::name(backend));
  return {std::string("ceiling/") + entry.name + "/" + name,
          device::needs_device(backend),
          "launch",
          entry.bound,
          [=, ceiling = entry.ceiling] {
            *kernel = create_ceiling(backend, ceiling);
            return Sample{[=] { (*kernel)->reset(); },
                          [=] {
                            (*kernel)->run();
                            return 1L;
                          }};
          },
          [=] { return (*kernel)->error(); },
          entry.tolerance,
          [=] {
            return Facts{name, 0, "", (*kernel)->flops(), (*kernel)->bytes()};
          }};
}

}  // namespace

std::vector<Case> ceiling_cases() {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends())
    for (const CeilingEntry& entry : ceilings)
      if (device::is_present(backend)) cases.push_back(ceiling_case(backend, entry));
  return cases;
}

}  // namespace drogue::perf
