#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "tests/support/fabric_sheets.hpp"

// Energy drift if states were stored in single precision, with all arithmetic in double precision.

namespace drogue::fabric {
namespace {

using testing::Sheets;

/// Quantities stored in single precision, velocities included except for `none`.
enum class SingleStorage { none, positions, displacements };

double to_single(double value) { return static_cast<double>(static_cast<float>(value)); }

/// Rounds a state to single precision: velocities, and positions or displacements from rest.
void round_state(SingleStorage storage, Sheets& s) {
  if (storage == SingleStorage::none) return;
  for (std::size_t i = 0; i < s.x.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double origin = storage == SingleStorage::displacements ? s.p.mesh.rest[i][axis] : 0.0;
      s.x[i][axis] = origin + to_single(s.x[i][axis] - origin);
      s.v[i][axis] = to_single(s.v[i][axis]);
    }
}

/// Largest drift of the energy over the initial kinetic energy in 500 steps, with the state rounded after
/// each. A sheet of 0.4 m, stretched by 5 % and pinned along its boundary, oscillates by a tenth of a
/// millimetre.
double drift(SingleStorage storage) {
  Sheets s;
  s.add(16, 0.4, [](double a, double b) { return Vector{1.05 * a, 1.05 * b, 0.0}; }, {0.0, 0.0, 0.0});
  s.p.contact = {};
  s.p.integrator = Integrator::rk4;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const Vector& at = s.p.mesh.rest[i];
    const double shape = std::sin(7.853981633974483 * at[0]) * std::sin(7.853981633974483 * at[1]);
    const bool edge = std::min(at[0], at[1]) == 0.0 || std::max(at[0], at[1]) == 0.4;
    s.p.pinned.push_back(edge ? 7 : 0);
    s.v[i][2] = edge ? 0.0 : 0.01 * shape;
  }
  s.p.dt = 1e-4;
  const auto solver = create_solver(device::Backend::serial, s.p);
  round_state(storage, s);
  solver->upload(s.x, s.v);
  const Totals start = solver->totals();
  double largest = 0.0;
  for (int step = 0; step < 500; ++step) {
    EXPECT_TRUE(solver->enqueue_steps(1));
    solver->download(s.x, s.v);
    round_state(storage, s);
    solver->upload(s.x, s.v);
    largest = std::max(largest, std::abs(solver->totals().energy() - start.energy()) / start.kinetic);
  }
  return largest;
}

// ctest-label: no-sanitizer
TEST(FabricStorage, SinglePrecisionStorageLosesEnergyConservation) {
  EXPECT_LT(drift(SingleStorage::none), 2e-8);
  // Wide tolerances: the drift by rounding is random.
  EXPECT_NEAR(drift(SingleStorage::displacements), 7e-5, 4e-5);
  EXPECT_NEAR(drift(SingleStorage::positions), 2.2e-2, 1.2e-2);
}

}  // namespace
}  // namespace drogue::fabric
