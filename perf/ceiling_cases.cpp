#include <memory>

#include "kernels/device/ceilings.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

namespace {

struct CeilingName {
  device::Ceiling ceiling;
  const char *name, *bound;
  double tolerance;  ///< relative; the chains round at every step, the triads never
};

constexpr CeilingName ceilings[] = {
    {device::Ceiling::fp64, "fp64", "FP64 multiply-add units", 1e-9},
    {device::Ceiling::memory, "memory", "memory bandwidth", 0.0},
    {device::Ceiling::cache, "cache", "bandwidth of the L1 cache, on a GPU of the L2 cache", 0.0}};

Case ceiling_case(device::Backend backend, const CeilingName& what) {
  const auto kernel = std::make_shared<std::unique_ptr<device::CeilingKernel>>();
  const std::string name(device::name(backend));
  return {std::string("ceiling/") + what.name + "/" + name,
          "launch",
          what.bound,
          [=, ceiling = what.ceiling] {
            *kernel = device::create_ceiling(backend, ceiling);
            return Sample{[=] { (*kernel)->reset(); },
                          [=] {
                            (*kernel)->run();
                            return 1L;
                          }};
          },
          [=] { return (*kernel)->error(); },
          what.tolerance,
          [=] {
            return Facts{name, 0, "", (*kernel)->flops(), (*kernel)->bytes()};
          }};
}

}  // namespace

std::vector<Case> ceiling_cases() {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends())
    for (const CeilingName& what : ceilings)
      if (device::is_present(backend)) cases.push_back(ceiling_case(backend, what));
  return cases;
}

}  // namespace drogue::perf
