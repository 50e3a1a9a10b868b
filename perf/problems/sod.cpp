#include "perf/problems/sod.hpp"

#include <cmath>
#include <memory>
#include <memory_resource>

#include "kernels/reference/gas/exact_riemann.hpp"
#include "perf/memory/memory.hpp"

namespace drogue::perf::sod {

gas::Parameters parameters(std::int64_t cells) {
  gas::Parameters p;
  p.cells = cells;
  p.weno = gas::Weno::js;
  p.positivity = gas::Positivity::off;
  p.ramp_steps = 0;
  return p;
}

reference::Primitive initial(double x) {
  return x < 0.0 ? reference::Primitive{1.0, 0.0, 1.0} : reference::Primitive{0.125, 0.0, 0.1};
}

double centre(const gas::Parameters& p, std::size_t i) {
  return p.x_min + (static_cast<double>(i) + 0.5) * (p.x_max - p.x_min) / static_cast<double>(p.cells);
}

Fields start(const gas::Parameters& p) {
  Fields fields;
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.cells); ++i) {
    const reference::Conserved u = reference::to_conserved(initial(centre(p, i)), p.gamma);
    for (std::size_t k = 0; k < 3; ++k) fields[k].push_back(u[k]);
  }
  return fields;
}

Sample steps(const gas::Parameters& p, device::Backend backend, const std::shared_ptr<gas::Solver>& solver,
             long count) {
  struct Start {
    std::shared_ptr<std::pmr::memory_resource> memory;
    std::array<std::pmr::vector<double>, 3> fields;
  };
  const Fields fields = start(p);
  const auto memory = host_memory(backend, HostMemory::pinned);
  const auto copy = [&](std::size_t k) {
    return std::pmr::vector<double>(fields[k].begin(), fields[k].end(), memory.get());
  };
  return {[solver, from = std::make_shared<Start>(Start{memory, {copy(0), copy(1), copy(2)}})] {
            solver->upload(0, {from->fields[0], from->fields[1], from->fields[2]});
            solver->start();
          },
          [=] {
            solver->advance(1.0, count, 0, {}, {});
            return count;
          },
          [=] { return l1_error(p, *solver); }};
}

Case baseline_case(const std::string& name, const std::string& bound, device::Backend backend,
                   const gas::Parameters& p, bool compute_alone) {
  return {.name = name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = bound,
          .tolerance = tolerance(p),
          .prepare = [=] {
            const std::shared_ptr<gas::Solver> solver = gas::create_baseline_solver(backend, p);
            const auto before = std::make_shared<gas::PhaseTimes>();
            const Fields from = start(p);
            return Sample{
                [=] {
                  solver->upload(0, {from[0], from[1], from[2]});
                  solver->start();
                  *before = solver->phase_times();
                },
                [=] {
                  solver->advance(1.0, baseline_steps, 0, {}, {});
                  return baseline_steps;
                },
                [=] { return l1_error(p, *solver); },
                [=] {
                  const gas::PhaseTimes now = solver->phase_times();
                  std::map<std::string, double> parts = {{"compute", now.compute - before->compute}};
                  if (!compute_alone)
                    parts.insert({{"h2d", now.h2d - before->h2d}, {"d2h", now.d2h - before->d2h}});
                  return parts;
                }};
          }};
}

double l1_error(const gas::Parameters& p, const std::vector<double>& rho, double time) {
  const reference::ExactRiemann exact({1.0, 0.0, 1.0}, {0.125, 0.0, 0.1}, p.gamma);
  double sum = 0.0;
  for (std::size_t i = 0; i < rho.size(); ++i)
    sum += std::abs(rho[i] - exact.sample(centre(p, i) / time).rho);
  return sum / static_cast<double>(rho.size());
}

double l1_error(const gas::Parameters& p, gas::Solver& solver) {
  Fields now;
  for (auto& values : now) values.resize(static_cast<std::size_t>(p.cells));
  solver.download(0, {now[0], now[1], now[2]});
  return l1_error(p, now[0], solver.restart_state().time);
}

double tolerance(const gas::Parameters& p) { return 1.0 / static_cast<double>(p.cells); }

}  // namespace drogue::perf::sod
