// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "perf/ladders/exercises/exercises.hpp"
#include "perf/ladders/ladder.hpp"
#include "perf/ladders/options/problem.hpp"
#include "tests/support/backend.hpp"

// Every rung of every ladder against the reference of its ladder, without timing.

namespace drogue::perf::ladder {
namespace {

class Ladders : public ::testing::TestWithParam<std::string> {
 protected:
  Ladder ladder = create_ladder(GetParam(), testing::tested_backend, true);
};

// ctest-label: smoke
TEST_P(Ladders, RungsEqualReference) {
  for (const Rung& rung : ladder.rungs) {
    if (!rung.available) continue;
    const auto run = rung.make();
    for (int round = 0; round < 2; ++round) {
      run->reset();
      EXPECT_GT(run->error(), rung.tolerance) << rung.text.name << " before round " << round;
      run->run();
      EXPECT_LE(run->error(), rung.tolerance) << rung.text.name << " after round " << round;
    }
  }
}

TEST_P(Ladders, PredictionsArePositiveAndFinite) {
  const Ceilings machine{1e-6, 1e-5, 1e9, 2e9, 1e10, 1e10, 1e9, 4, 1e9};
  for (const Rung& rung : ladder.rungs) {
    const Prediction predicted = predict(rung.work, machine);
    EXPECT_GT(predicted.seconds, 0.0) << rung.text.name;
    EXPECT_TRUE(std::isfinite(predicted.seconds)) << rung.text.name;
    EXPECT_STRNE(predicted.bound, "") << rung.text.name;
  }
}

TEST_P(Ladders, RungsHaveDistinctNamesAndTexts) {
  std::set<std::string> names, hindsights;
  for (const Rung& rung : ladder.rungs) {
    names.insert(rung.text.name);
    hindsights.insert(rung.text.hindsight);
    EXPECT_STRNE(rung.text.idea, "") << rung.text.name;
    EXPECT_STRNE(rung.text.hindsight, "") << rung.text.name;
  }
  EXPECT_EQ(names.size(), ladder.rungs.size());
  EXPECT_EQ(hindsights.size(), ladder.rungs.size());
}

INSTANTIATE_TEST_SUITE_P(All, Ladders, ::testing::ValuesIn(names()),
                         [](const auto& tested) { return tested.param; });

TEST(Prediction, AddsCopiesAndLaunchesToTheLongerOfMemoryAndArithmetic) {
  Ceilings machine;
  machine.launch = machine.copy = 1.0;
  machine.pageable = machine.pinned = machine.bandwidth = machine.flops = machine.divisions = 10.0;
  machine.lanes = 4, machine.scalar_divisions = 6.0;
  Work work;
  work.launches = 2.0, work.copies = 3.0, work.copied_bytes = 40.0, work.bytes = 50.0, work.flops = 60.0;
  EXPECT_EQ(predict(work, machine).seconds, 3.0 + 4.0 + 2.0 + 4.0 * 6.0);
  EXPECT_STREQ(predict(work, machine).bound, "arithmetic");
  work.divisions = 30.0;
  EXPECT_EQ(predict(work, machine).seconds, 3.0 + 4.0 + 2.0 + 4.0 * 6.0 + 5.0);
  work.packed = true;
  EXPECT_EQ(predict(work, machine).seconds, 3.0 + 4.0 + 2.0 + 6.0 + 3.0);
  work.divisions = 0.0;
  EXPECT_EQ(predict(work, machine).seconds, 3.0 + 4.0 + 2.0 + 6.0);
  EXPECT_STREQ(predict(work, machine).bound, "copies");
  work.overlapped = true;
  EXPECT_EQ(predict(work, machine).seconds, 2.0 + 6.0);
}

// The reference of the options ladder, whose rungs only show that they compute the same. Its error is that of
// 32 Euler steps: a sixteenth of the step leaves 2e-4 of it.
TEST(OptionsLadder, ReferenceApproximatesMertonSeries) {
  const OptionsProblem problem = make_options_problem(64);
  for (int k = 0; k < 64; ++k) {
    const double value = problem.expected[static_cast<std::size_t>(k * option_nodes + option_nodes / 2)];
    EXPECT_NEAR(value, merton_put(k), 1.5e-3) << "option " << k;
  }
}

// Or right and slow: their times are no matter of a test.
TEST(LadderExercises, ShippedCodeIsBroken) {
  for (const Exercise& exercise : create_exercises(testing::tested_backend, ExerciseCode::own))
    EXPECT_EQ(error_of(exercise) > exercise.rung.tolerance, exercise.factor == 0.0) << exercise.name;
}

TEST(LadderExercises, SolutionsAreAccepted) {
  for (const Exercise& exercise : create_exercises(testing::tested_backend, ExerciseCode::solution))
    EXPECT_LE(error_of(exercise), exercise.rung.tolerance) << exercise.name;
}

TEST(MeasuredCeilings, ArePositive) {
  const Ceilings c = measure_ceilings(testing::tested_backend);
  for (const double rate :
       {c.launch, c.copy, c.pageable, c.pinned, c.bandwidth, c.flops, c.divisions, c.scalar_divisions})
    EXPECT_GT(rate, 0.0);
}

}  // namespace
}  // namespace drogue::perf::ladder
