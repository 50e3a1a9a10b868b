#include "common/study/ensemble.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "tests/support/refusal.hpp"

namespace drogue::study {
namespace {

std::string refusal(const std::string& text) {
  return testing::refusal_of([&] { return parse_ensemble(text); }, ExitCode::usage);
}

TEST(Ensemble, ParsesItsAxes) {
  const EnsembleAxes axes = parse_ensemble("ensemble=8,cells=1:1.5,jobs=3");
  EXPECT_EQ(axes.runs, 8);
  EXPECT_EQ(axes.factors, (std::vector{1.0, 1.5}));
  EXPECT_EQ(axes.jobs, 3);
  EXPECT_EQ(parse_ensemble("cells=2").factors, std::vector{2.0});
  EXPECT_EQ(parse_ensemble("ensemble=4").factors, std::vector{1.0});
  EXPECT_TRUE(is_ensemble("cells=1:2", {"meshes", "times"}));
  EXPECT_FALSE(is_ensemble("meshes=100:800,times=rk3", {"meshes", "times"}));
}

TEST(Ensemble, RefusesUnknownAxesAndThoseOfTwoStudies) {
  for (const auto& [text, what] :
       {std::pair{
            "ensemble=4,meshes=1:2",
            "--study: meshes cannot be combined with ensemble, cells and jobs; cells=1:2 names two grids, "
            "the second with twice as many cells along each axis"},
        {"ensembel=2", "--study: unknown name 'ensembel'; did you mean \"ensemble\"?"},
        {"cells=1,mesh=4", "--study: unknown name 'mesh'; did you mean \"meshes\"?"},
        {"nonsense", "--study: unknown name 'nonsense'; valid names are ensemble, cells, jobs, meshes"},
        {"ensemble=2,", "--study: a part is empty; valid names are ensemble, cells, jobs, meshes"}})
    EXPECT_EQ(testing::refusal_of([name = text] { return is_ensemble(name, {"meshes"}); }, ExitCode::usage),
              what);
}

TEST(Ensemble, RefusesOtherAxes) {
  EXPECT_EQ(refusal("ensemble=0"), "--study: ensemble=0 is not an integer between 1 and 10000");
  EXPECT_EQ(refusal("ensemble=8,meshes=4"),
            "--study: unknown name 'meshes'; valid names are ensemble, cells, jobs");
  EXPECT_EQ(refusal("ensemble=2,"), "--study: a part is empty; valid names are ensemble, cells, jobs");
  EXPECT_NE(refusal("cells=1:").find("'' is no factor"), std::string::npos);
  EXPECT_EQ(refusal("jobs=2,jobs=2"), "--study: the axis jobs is named twice");
  EXPECT_EQ(refusal("ensemble"), "--study: an axis needs values: ensemble=...");
  EXPECT_NE(refusal("cells=1.5:1").find("at least 1.1 times"), std::string::npos);
  EXPECT_NE(refusal("cells=1:2:3").find("more than two grids"), std::string::npos);
  EXPECT_NE(refusal("cells=1:x").find("'x' is no factor"), std::string::npos);
  EXPECT_NE(refusal("cells=nan").find("'nan' is no factor"), std::string::npos);
}

Member member(std::size_t grid, std::vector<Quantity> quantities, ExitCode code = ExitCode::ok) {
  Member one;
  one.folder = "cells-" + std::to_string(grid);
  one.grid = grid;
  one.seed = 1;
  one.code = code;
  one.quantities = std::move(quantities);
  return one;
}

TEST(Ensemble, GivesErrorBarsOfTheFinestGrid) {
  const std::vector<Member> members = {
      member(1, {{"canopy_0.drag", 1.0, 0.01}, {"peak", 100.0, NAN}}),
      member(1, {{"canopy_0.drag", 1.2, 0.01}, {"peak", 120.0, NAN}}, ExitCode::verification_failed),
      member(1, {}, ExitCode::numerical_failure),
      member(0, {{"canopy_0.drag", 1.3, 0.01}, {"peak", 90.0, NAN}}),
      member(0, {{"canopy_0.drag", 1.3, 0.01}}),
  };
  const std::vector<double> factors = {1.0, 1.5};
  const std::vector<StudyQuantity> all = summarize(members, factors);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "canopy_0.drag");
  EXPECT_EQ(all[0].grids[1].runs, 2U);
  EXPECT_DOUBLE_EQ(all[0].bar.value, 1.1);
  const run::ErrorBar expected = run::error_bar(all[0].grids[0], all[0].grids[1], 1.5);
  EXPECT_DOUBLE_EQ(all[0].bar.half_width, expected.half_width);
  EXPECT_GT(expected.grid, run::grid_safety * 0.2 / 0.5);
  EXPECT_TRUE(std::isnan(all[1].bar.grid)) << "one run on the coarse grid has no error";
  EXPECT_NE(text_of(all[1]).find("of a run: standard deviation 14.1, 5 to 95 % 101 to 119"),
            std::string::npos)
      << text_of(all[1]);
  run::Metrics metrics;
  describe({2, factors, 1}, members, all, metrics);
  EXPECT_EQ(metrics.integer("study", "runs"), 5);
  EXPECT_EQ(metrics.integer("study", "finished"), 4);
  EXPECT_EQ(metrics.integer("study", "failed"), 1);
  EXPECT_EQ(metrics.real("study", "canopy_0_drag"), 1.1);
  EXPECT_EQ(metrics.real("study", "canopy_0_drag_coarse"), 1.3);
  EXPECT_EQ(metrics.integer("study", "peak_runs"), 2);
  EXPECT_TRUE(members_csv(members, factors)
                  .starts_with("folder,cells,seed,status,steps,wall_s,canopy_0.drag,peak\n"
                               "cells-1,1.5,1,ok,0,0,1,100\n"
                               "cells-1,1.5,1,verification-failed,0,0,1.2,120\n"
                               "cells-1,1.5,1,numerical-failure,0,0,,\n"))
      << members_csv(members, factors);
}

TEST(Ensemble, TextNamesThePartsOfABar) {
  StudyQuantity quantity{"C_D0",
                         {run::distribution_of({0.8, 0.81}), run::distribution_of({0.79, 0.79})},
                         {0.79, 0.0352, 0.012, 0.033}};
  EXPECT_EQ(text_of(quantity), "0.790 +- 0.035 (sampling 0.012, grid 0.033)");
  quantity.grids.erase(quantity.grids.begin());
  quantity.bar = {0.79, 0.01, 0.01, 0.0};
  EXPECT_EQ(text_of(quantity), "0.790 +- 0.010 (sampling 0.01, grid not known)");
}

class MemberFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(_file); }

  Member read(const std::string& json, int exit_code = 0, const std::string& log = "") {
    if (!json.empty()) std::ofstream(_file) << json;
    Member one;
    read_member(_file, exit_code, log, one);
    return one;
  }

 private:
  std::filesystem::path _file =
      std::filesystem::temp_directory_path() / ("member" + std::to_string(::getpid()) + ".json");
};

TEST_F(MemberFile, HasResultsAndMeasuredChecks) {
  const Member one = read(R"({"exit_code": 5, "message": "a check", "steps": 7, "timing": {"wall_s": 2.5},
    "checks": [{"name": "drag", "measured": 3.0, "error": 0.1}, {"name": "divergence", "value": 1e-15}],
    "canopies": {"vertices": 12},
    "canopy_0": {"from": 1.0, "drift": 0.5, "drift_error": 0.2, "peak_line_force": 9.0, "leak": null}})",
                          5);
  EXPECT_TRUE(one.is_finished());
  EXPECT_EQ(one.steps, 7);
  EXPECT_EQ(one.wall_s, 2.5);
  ASSERT_EQ(one.quantities.size(), 3U);
  EXPECT_EQ(one.quantities[0].name, "canopy_0.drift");
  EXPECT_EQ(one.quantities[0].half_width, 0.2);
  EXPECT_TRUE(std::isnan(one.quantities[1].half_width));
  EXPECT_EQ(one.quantities[2].name, "drag");
  EXPECT_EQ(one.quantities[2].half_width, 0.1);
}

TEST_F(MemberFile, OfAnotherRunHasNoResults) {
  const std::string older = R"({"exit_code": 0, "canopy_0": {"drift": 1.0}})";
  for (const int code : {2, 137}) {
    const Member failed = read(older, code);
    EXPECT_FALSE(failed.is_finished());
    EXPECT_TRUE(failed.quantities.empty());
    EXPECT_EQ(failed.message,
              "it ended with code " + std::to_string(code) + ", which its result.json does not have");
  }
}

TEST_F(MemberFile, OfAFailureHasNoResults) {
  const Member failed = read(R"({"exit_code": 4, "message": "NaN", "canopy_0": {"drift": 1.0}})", 4);
  EXPECT_EQ(failed.code, ExitCode::numerical_failure);
  EXPECT_EQ(failed.message, "NaN");
  EXPECT_TRUE(failed.quantities.empty());
}

TEST_F(MemberFile, MayBeMissing) {
  EXPECT_EQ(read("", 3, "a sentence").message, "a sentence");
  EXPECT_EQ(read("", 139).code, ExitCode::io_error) << "a signal";
  EXPECT_EQ(read("", 0).code, ExitCode::io_error);
  EXPECT_EQ(read("", 130).code, ExitCode::interrupted);
  EXPECT_EQ(read("{ truncated", 137).message, "it ended with code 137 and left no result.json");
}

}  // namespace
}  // namespace drogue::study
