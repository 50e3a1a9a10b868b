#include <algorithm>
#include <cmath>
#include <memory>

#include "kernels/gas/solver.hpp"
#include "kernels/reference/gas/dense_step.hpp"
#include "kernels/reference/gas/exact_riemann.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

namespace {

/// Sod's problem on [-1, 1] in WENO5-JS, SSP-RK3, alpha over the stencil, without a limiter: what the
/// yardstick does.
gas::Parameters parameters_of(std::int64_t cells) {
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

/// L1 error of the density against the exact solution at `time`, per unit length.
double l1_error(const gas::Parameters& p, const std::vector<double>& rho, double time) {
  const reference::ExactRiemann exact({1.0, 0.0, 1.0}, {0.125, 0.0, 0.1}, p.gamma);
  double sum = 0.0;
  for (std::size_t i = 0; i < rho.size(); ++i)
    sum += std::abs(rho[i] - exact.sample(centre(p, i) / time).rho);
  return sum / static_cast<double>(rho.size());
}

/// First-order convergence at the discontinuities, with room: a wrong step misses it by decades.
double bar_of(const gas::Parameters& p) { return 1.0 / static_cast<double>(p.cells); }

Case dense_case(std::int64_t cells, long steps) {
  struct Run {
    std::vector<reference::Conserved> state;
    reference::DenseWorkspace workspace;
    double time = 0.0;
  };
  const auto run = std::make_shared<Run>();
  const gas::Parameters p = parameters_of(cells);
  const double dx = (p.x_max - p.x_min) / static_cast<double>(cells);
  return {"gas-step/dense-loop/" + std::to_string(cells),
          "step",
          "one core; no vectorisation is asked for",
          [=] {
            return Sample{[=] {
                            run->time = 0.0;
                            run->state.clear();
                            for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i)
                              run->state.push_back(reference::to_conserved(initial(centre(p, i)), p.gamma));
                          },
                          [=] {
                            for (long step = 0; step < steps; ++step)
                              run->time +=
                                  reference::dense_step(run->state, run->workspace, p.gamma, dx, p.cfl);
                            return steps;
                          }};
          },
          [=] {
            std::vector<double> rho;
            for (const auto& u : run->state) rho.push_back(u[0]);
            return l1_error(p, rho, run->time);
          },
          bar_of(p)};
}

/// A change of the usual parameters, and what it adds to the name of the case.
struct Variant {
  const char* name;
  void (*apply)(gas::Parameters&);
};

/// What a step costs beside the usual one, where nothing but arithmetic counts, and where launches count
/// most.
const std::vector<Variant> large_variants = {
    {"/z", [](gas::Parameters& p) { p.weno = gas::Weno::z; }},
    {"/teno5", [](gas::Parameters& p) { p.weno = gas::Weno::teno5; }},
    {"/split", [](gas::Parameters& p) { p.precision = gas::Precision::split; }},
    {"/auto", [](gas::Parameters& p) { p.positivity = gas::Positivity::automatic; }},
    {"/on", [](gas::Parameters& p) { p.positivity = gas::Positivity::on; }}};
const std::vector<Variant> small_variants = {
    {"/plain", [](gas::Parameters& p) { p.driver = gas::Driver::plain; }},
    {"/graph", [](gas::Parameters& p) { p.driver = gas::Driver::graph; }},
    {"/split", [](gas::Parameters& p) { p.precision = gas::Precision::split; }}};

Case solver_case(device::Backend backend, std::int64_t cells, long steps, const Variant& variant) {
  gas::Parameters p = parameters_of(cells);
  variant.apply(p);
  const auto solver = std::make_shared<std::unique_ptr<gas::Solver>>();
  const std::string name(device::name(backend));
  return {"gas-step/" + name + "/" + std::to_string(cells) + variant.name,
          "step",
          backend == device::Backend::cuda ? "launch latency below 100k cells, FP64 issue above"
                                           : "FP64 issue of the cores",
          [=] {
            *solver = gas::create_solver(backend, p);
            std::vector<double> rho, momentum(static_cast<std::size_t>(cells), 0.0), energy;
            for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i) {
              const auto u = reference::to_conserved(initial(centre(p, i)), p.gamma);
              rho.push_back(u[0]);
              energy.push_back(u[2]);
            }
            return Sample{[=] {
                            (*solver)->upload(0, {rho, momentum, energy});
                            (*solver)->start();
                          },
                          [=] {
                            (*solver)->advance(1.0, steps, 0, {}, {});
                            return steps;
                          }};
          },
          [=] {
            std::vector<double> rho(static_cast<std::size_t>(cells)), momentum(rho.size()),
                energy(rho.size());
            (*solver)->download(0, {rho, momentum, energy});
            return l1_error(p, rho, (*solver)->resume_state().time);
          },
          bar_of(p)};
}

}  // namespace

std::vector<Case> gas_cases(bool quick) {
  std::vector<Case> cases;
  for (const std::int64_t cells : quick ? std::vector<std::int64_t>{1024, 8192}
                                        : std::vector<std::int64_t>{1024, 8192, 65536, 1 << 20, 1 << 24}) {
    for (const device::Backend backend : device::compiled_backends()) {
      if (!device::is_present(backend)) continue;
      const bool gpu = backend == device::Backend::cuda;
      if (!gpu && cells > 1 << 20) continue;
      // A sample: about 20 ms of work, but enough steps that its start and end do not show, and not so many
      // that the waves reach the ends, where the exact solution ends too.
      const long n = static_cast<long>(cells);
      const long steps =
          gpu ? std::clamp(n / 2, 10L, std::max(10L, 2000L / (1 + n / 65536))) : std::max(4L, 200'000L / n);
      cases.push_back(solver_case(backend, cells, steps, {"", [](gas::Parameters&) {}}));
      if (gpu && cells == 8192)
        for (const Variant& variant : small_variants)
          cases.push_back(solver_case(backend, cells, steps, variant));
      if (gpu && cells == 1 << 24)
        for (const Variant& variant : large_variants)
          cases.push_back(solver_case(backend, cells, steps, variant));
    }
    if (cells <= 8192) cases.push_back(dense_case(cells, std::max(2L, 50'000L / static_cast<long>(cells))));
  }
  return cases;
}

}  // namespace drogue::perf
