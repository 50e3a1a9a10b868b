#include <cstdio>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "kernels/gas/solver.hpp"

// A gas of uniform density and speed between periodic ends: its mass after 20 steps is what it was, 2 kg/m^2.
int main() {
  const drogue::device::Runtime runtime({});
  drogue::gas::Parameters parameters{.left = drogue::gas::Boundary::periodic,
                                     .right = drogue::gas::Boundary::periodic};
  parameters.cells = 64;
  const auto solver = drogue::gas::create_solver(drogue::device::fastest_backend(), parameters);
  const std::vector<double> rho(64, 1.0), momentum(64, 0.5), energy(64, 3.0);
  solver->upload(0, {rho, momentum, energy});
  solver->start();
  solver->advance(
      1.0e3, 20, 0, [](const auto&) {}, [](const auto&) { return true; });
  std::printf("steps %lld mass %.12f\n", static_cast<long long>(solver->totals().step),
              solver->totals().mass);
}
