#include <gtest/gtest.h>

#include "common/program/failure.hpp"
#include "common/program/progress.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {
namespace {

Command parse(std::vector<const char*> words) {
  words.insert(words.begin(), "drogue-options");
  return parse_command(static_cast<int>(words.size()), words.data());
}

TEST(OptionsCommand, FillsInDefaults) {
  const Command command = parse({"price", "b.csv"});
  EXPECT_EQ(command.action, Action::price);
  EXPECT_EQ(command.input, "b.csv");
  EXPECT_EQ(command.out, "prices.csv");
  EXPECT_EQ(command.settings.method, options::Method::pide);
  EXPECT_EQ(command.settings.tolerance, 1e-4);
  EXPECT_EQ(command.settings.mesh, 0);
  EXPECT_EQ(command.chunk, 0U);
}

TEST(OptionsCommand, ParsesEveryOption) {
  const Command command =
      parse({"price", "b.csv", "--out", "o", "--mesh", "128", "--steps", "32", "--method", "seed", "--greeks",
             "--result", "r", "--chunk", "5", "--quiet", "--kokkos-device-id=0"});
  EXPECT_EQ(command.settings.method, options::Method::baseline);
  EXPECT_EQ(command.settings.mesh, 128);
  EXPECT_EQ(command.settings.steps, 32);
  EXPECT_TRUE(command.settings.greeks);
  EXPECT_EQ(command.chunk, 5U);
  EXPECT_EQ(command.kokkos, std::vector<std::string>{"--kokkos-device-id=0"});
}

TEST(OptionsCommand, SharesSolvesOnlyOfPideSurfaces) {
  const Command command = parse({"surface", "p.csv", "--strikes", "1:2:3", "--maturities", "0.5,1"});
  EXPECT_EQ(command.action, Action::surface);
  EXPECT_EQ(command.strikes, (std::vector<double>{1.0, 1.5, 2.0}));
  EXPECT_EQ(command.maturities, (std::vector<double>{0.5, 1.0}));
  EXPECT_TRUE(command.settings.surface);
  EXPECT_FALSE(
      parse({"surface", "p.csv", "--strikes", "1", "--maturities", "1", "--method", "cos"}).settings.surface);
  EXPECT_FALSE(parse({"price", "b.csv"}).settings.surface);
}

TEST(OptionsCommand, ParsesRangesAndRejectsInvalidValues) {
  EXPECT_EQ(parse_values("--x", "0.8:0.8:1"), std::vector<double>{0.8});
  EXPECT_EQ(parse_values("--x", "1,"), std::vector<double>{1.0});
  EXPECT_EQ(parse_values("--x", "0.8:1.2:41").back(), 1.2);
  EXPECT_EQ(parse_values("--x", "0.8:1.2:41").size(), 41U);
  for (const char* text : {"", ",", " ", "1 2", "1,2 3", "1 0:20:3", "1:2", "1:2:0", "1:2:1", "1:2:3:4",
                           "0:1:3", "-1", "nan", "1:2:20000", "1:2:1.5"})
    EXPECT_THROW((void)parse_values("--x", text), Failure) << text;
}

TEST(RowsText, ShowsRateAndRemainingTime) {
  EXPECT_EQ(rows_text(500, 0.25, 10.0), "500 rows (25 %)  50 rows/s  ETA 0:30");
  EXPECT_EQ(rows_text(0, 0.0, 0.0), "0 rows (0 %)  0 rows/s  ETA -");
}

}  // namespace
}  // namespace drogue::options_app
