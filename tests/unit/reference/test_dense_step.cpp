#include <gtest/gtest.h>

#include <cmath>

#include "kernels/reference/gas/dense_step.hpp"
#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {
namespace {

TEST(DenseStep, EqualsTheReferenceStep) {
  gas::Parameters p;
  p.cells = 200;
  p.weno = gas::Weno::js;
  p.ramp_steps = 0;
  p.positivity = gas::Positivity::off;
  const auto tube = [](double x) { return x < 0.0 ? Primitive{1, 0, 1} : Primitive{.125, 0, .1}; };
  std::vector<Conserved> state = start_run(p, tube).state;
  DenseWorkspace workspace;
  double time = 0.0;
  for (int step = 0; step < 50; ++step) time += dense_step(state, workspace, p.gamma, 0.01, p.cfl);
  // Slightly early: the sums of dt differ in their last digits, which must not lead to a 51st step.
  const GasRun run = reference_run(p, tube, time * (1.0 - 1e-13));
  EXPECT_EQ(run.steps, 50);
  for (std::size_t i = 0; i < 200; ++i)
    for (std::size_t s = 0; s < 3; ++s) EXPECT_NEAR(state[i][s], run.state[i][s], 1e-11) << "cell " << i;
}

}  // namespace
}  // namespace drogue::reference
