#include <memory>

#include "perf/cases/cases.hpp"
#include "perf/ceilings/ceilings.hpp"
#include "perf/measure/parts.hpp"

namespace drogue::perf {

namespace {

struct CeilingEntry {
  Ceiling ceiling;
  const char *name, *bound;
  double tolerance;  ///< relative; the chains round at every step, the triads are exact
};

constexpr CeilingEntry ceilings[] = {
    {Ceiling::fp64, "fp64", "FP64 multiply-add units", 1e-9},
    {Ceiling::fp32, "fp32", "FP32 multiply-add units", 1e-3},
    {Ceiling::issue, "issue", "issue of instructions", 1e-3},
    {Ceiling::memory, "memory", "memory bandwidth", 0.0},
    {Ceiling::cache, "cache", "bandwidth of the L1 cache, on a GPU of the L2 cache", 0.0},
    {Ceiling::l2, "l2", "bandwidth of the L2 cache", 0.0},
    {Ceiling::l3, "l3", "bandwidth of the L3 cache", 0.0},
    {Ceiling::launch, "launch", "latency of a launch", 0.0},
    {Ceiling::graph_node, "graph-node", "latency of a kernel in a graph", 0.0}};

Case ceiling_case(device::Backend backend, const CeilingEntry& entry) {
  return {.name = std::string("ceiling/") + entry.name + "/" + std::string(device::name(backend)),
          .backend = backend,
          .unit_of_work = "launch",
          .bound = entry.bound,
          .tolerance = entry.tolerance,
          .prepare = [backend, ceiling = entry.ceiling] {
            const std::shared_ptr<CeilingKernel> kernel = create_ceiling(backend, ceiling);
            return Sample{.reset = [=] { kernel->reset(); },
                          .work =
                              [=] {
                                kernel->run();
                                return kernel->launches();
                              },
                          .error = [=] { return kernel->error(); },
                          .complete =
                              [=](Facts& facts) {
                                facts.flops = kernel->flops();
                                facts.bytes = kernel->bytes();
                                facts.instructions = kernel->instructions();
                                if (device::needs_device(backend))
                                  facts.device_seconds = median_of_works([&] {
                                    kernel->reset();
                                    return kernel->timed_run() / static_cast<double>(kernel->launches());
                                  });
                              }};
          }};
}

}  // namespace

std::vector<Case> ceiling_cases() {
  std::vector<Case> cases;
  for (const device::Backend backend : present_backends())
    for (const CeilingEntry& entry : ceilings)
      if (has_ceiling(backend, entry.ceiling)) cases.push_back(ceiling_case(backend, entry));
  return cases;
}

}  // namespace drogue::perf
