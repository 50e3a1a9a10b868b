#include "perf/problems/baseline_case.hpp"

#include <memory>

#include "perf/problems/sod.hpp"

namespace drogue::perf {

std::map<std::string, double> all_phases(const gas::PhaseTimes& times) {
  return {{"h2d", times.h2d}, {"compute", times.compute}, {"d2h", times.d2h}};
}

Case baseline_case(const std::string& name, const std::string& bound, device::Backend backend,
                   const gas::Parameters& p,
                   const std::function<std::map<std::string, double>(const gas::PhaseTimes&)>& parts) {
  const auto solver = std::make_shared<std::unique_ptr<gas::Solver>>();
  const auto before = std::make_shared<gas::PhaseTimes>();
  return {
      .name = name,
      .on_device = device::needs_device(backend),
      .unit_of_work = "step",
      .bound = bound,
      .prepare =
          [=] {
            *solver = gas::create_baseline_solver(backend, p);
            const sod::Fields start = sod::start(p);
            return Sample{
                [=] {
                  (*solver)->upload(0, {start[0], start[1], start[2]});
                  (*solver)->start();
                  *before = (*solver)->phase_times();
                },
                [=] {
                  (*solver)->advance(1.0, baseline_steps, 0, {}, {});
                  return baseline_steps;
                },
                [=] {
                  const gas::PhaseTimes now = (*solver)->phase_times();
                  return parts({now.h2d - before->h2d, now.compute - before->compute, now.d2h - before->d2h});
                }};
          },
      .error = [=] { return sod::l1_error(p, **solver); },
      .tolerance = sod::tolerance(p)};
}

}  // namespace drogue::perf
