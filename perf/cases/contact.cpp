#include <memory>

#include "perf/cases/cases.hpp"
#include "perf/problems/roll.hpp"

namespace drogue::perf {

namespace {

Case roll_case(device::Backend backend, int vertices, long steps, fabric::Integrator integrator) {
  struct Run {
    fabric::Parameters p;
    std::unique_ptr<fabric::Solver> solver;
  };
  const auto run = std::make_shared<Run>();
  const std::string name(device::name(backend));
  const std::string variant = integrator == fabric::Integrator::verlet ? "verlet" : "";
  return {.name = "springs-contact/" + name + "/" + std::to_string(vertices) + (variant.empty() ? "" : "/") +
                  variant,
          .on_device = device::needs_device(backend),
          .unit_of_work = "step",
          .bound = backend == device::Backend::cuda
                       ? "latency of some fifty small kernels below 100k vertices"
                       : "distances of near parts, by the cores",
          .prepare =
              [=] {
                run->p = roll::parameters(vertices);
                run->p.integrator = integrator;
                run->solver = fabric::create_solver(backend, run->p);
                return roll::steps(run->p, *run->solver, steps);
              },
          .error = [=] { return roll::imbalance(run->p, *run->solver); },
          .tolerance = roll::tolerance(vertices),
          .facts =
              [=] {
                return Facts{name, static_cast<std::int64_t>(run->p.mass.size()), variant};
              }};
}

}  // namespace

std::vector<Case> contact_cases(bool quick) {
  std::vector<Case> cases;
  for (const int vertices : quick ? std::vector{640} : std::vector{15'625, 246'000})
    for (const device::Backend backend : device::compiled_backends()) {
      if (!device::is_present(backend)) continue;
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
