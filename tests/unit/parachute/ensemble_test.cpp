#include "miniapps/parachute/verify/ensemble.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/held_canopy.hpp"

namespace drogue::parachute_app {
namespace {

MiniAppOptions study(const std::string& text) {
  MiniAppOptions options;
  options.study = text;
  options.backend = "serial";
  return options;
}

TEST(EnsembleOfFlights, PerturbsAndRefinesTogether) {
  const SceneFile file;
  const framework::Ensemble ensemble = ensemble_of(study("ensemble=2,cells=0.5:1"), file.path());
  ASSERT_EQ(ensemble.runs.size(), 4U);
  EXPECT_EQ(ensemble.axes.factors, (std::vector{0.5, 1.0}));
  const framework::EnsembleRun &first = ensemble.runs.front(), &last = ensemble.runs.back();
  EXPECT_EQ(first.member.folder, "cells-1/seed-1") << "the longest first";
  EXPECT_EQ(last.member.folder, "cells-0.5/seed-2");
  const FlowScene base = file.read(), coarse = file.read(last.sets), other = file.read(first.sets);
  EXPECT_EQ(coarse.parameters.cells, (std::array{45, 45, 45}));
  EXPECT_DOUBLE_EQ(coarse.canopies[0].edge_length, 0.4);
  EXPECT_DOUBLE_EQ(coarse.parameters.max_dt, 2.0 * base.parameters.max_dt);
  EXPECT_EQ(coarse.canopies[0].perturbation.seed, 2);
  EXPECT_DOUBLE_EQ(coarse.canopies[0].perturbation.amplitude, 0.004) << "a fiftieth of the finest edge";
  EXPECT_DOUBLE_EQ(other.canopies[0].perturbation.amplitude, 0.004);
  EXPECT_TRUE(coarse.output.fields.empty());
}

TEST(EnsembleOfFlights, RefinesCoresWithTheirGrowth) {
  const SceneFile file;
  const std::vector<std::string> sets = {
      "grid={core=[[-8,8],[-8,8],[-9,7]], spacing=0.4, growth=1.06, "
      "domain=[[-18,18],[-18,18],[-18,18]], boundary={x=\"slip\", y=\"slip\", "
      "z=[\"inflow\",\"outflow\"]}}"};
  MiniAppOptions options = study("cells=1:2");
  options.set = sets;
  const framework::Ensemble ensemble = ensemble_of(options, file.path());
  std::vector<std::string> fine_sets = sets;
  fine_sets.insert(fine_sets.end(), ensemble.runs[0].sets.begin(), ensemble.runs[0].sets.end());
  const FlowScene fine = file.read(fine_sets), base = file.read(sets);
  EXPECT_DOUBLE_EQ(core_width(fine.parameters, 0), 0.2);
  EXPECT_DOUBLE_EQ(fine.growth, std::sqrt(1.06));
  const double ratio = static_cast<double>(fine.parameters.cells[0]) / base.parameters.cells[0];
  EXPECT_NEAR(ratio, 2.0, 0.05) << "beside the core too";
}

TEST(EnsembleOfFlights, GivesFlowsAnotherInitialVelocity) {
  const SceneFile file;
  std::ofstream(file.path()) << R"toml(app = "parachute"
[fluid]
velocity = ["2*(1-exp(-t))", 0, 0]
[grid]
cells = [16, 16, 1]
domain = [[0, 2], [-1, 1], [0, 1]]
boundary = { x = ["inflow", "outflow"], y = "slip" }
[run]
end_time = 20
)toml";
  const framework::Ensemble ensemble = ensemble_of(study("ensemble=2"), file.path());
  EXPECT_EQ(ensemble.runs[0].sets.front().find("initial.velocity=[\"(0.0)+0.0019999"), 0U)
      << ensemble.runs[0].sets.front();
  EXPECT_NE(ensemble.runs[0].sets.front(), ensemble.runs[1].sets.front());
  EXPECT_EQ(file.read(ensemble.runs[0].sets).initial[2], "0.0") << "nothing along an axis with one cell";
}

TEST(EnsembleOfFlights, RefusesGridsThatTheSceneCannotHave) {
  const SceneFile file;
  MiniAppOptions few = study("cells=0.1:1");
  few.set = {"grid.cells=[20,20,20]"};
  EXPECT_THROW((void)ensemble_of(few, file.path()), Failure) << "two cells along an axis";
  EXPECT_NE(ensemble_report(study("ensemble=8,cells=1:1.5,jobs=2"), file.path())
                .find("16 runs, 8 on each grid, 2 at once"),
            std::string::npos);
}

}  // namespace
}  // namespace drogue::parachute_app
