#include <memory>

#include "perf/cases/cases.hpp"
#include "perf/problems/roll.hpp"

namespace drogue::perf {

namespace {

Case roll_case(device::Backend backend, int vertices, long steps, fabric::Integrator integrator) {
  const std::string variant = integrator == fabric::Integrator::verlet ? "verlet" : "";
  return {
      .name = "springs-contact/" + std::string(device::name(backend)) + "/" + std::to_string(vertices) +
              (variant.empty() ? "" : "/") + variant,
      .backend = backend,
      .unit_of_work = "step",
      .bound = backend == device::Backend::cuda ? "latency of some fifty small kernels below 100k vertices"
                                                : "distances of near parts, by the cores",
      .tolerance = roll::tolerance(vertices),
      .prepare =
          [=] {
            const auto p = std::make_shared<fabric::Parameters>(roll::parameters(vertices));
            p->integrator = integrator;
            Sample sample = roll::steps(p, fabric::create_solver(backend, *p), steps);
            sample.complete = [=](Facts& facts) { facts.cells = static_cast<std::int64_t>(p->mass.size()); };
            return sample;
          },
      .facts = {.variant = variant}};
}

}  // namespace

std::vector<Case> contact_cases(bool quick) {
  std::vector<Case> cases;
  for (const int vertices : quick ? std::vector{640} : std::vector{15'625, 246'000})
    for (const device::Backend backend : present_backends()) {
      const bool gpu = backend == device::Backend::cuda;
      if (!gpu && vertices > 100'000) continue;
      // The first step builds the lists of contact candidates; they are rebuilt every few dozen steps.
      const long steps = gpu ? 64 : 16;
      cases.push_back(roll_case(backend, vertices, steps, fabric::Integrator::rk4));
      if (gpu) cases.push_back(roll_case(backend, vertices, steps, fabric::Integrator::verlet));
    }
  return cases;
}

}  // namespace drogue::perf
