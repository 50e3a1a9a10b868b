#include <gtest/gtest.h>

#include "perf/rows/rows.hpp"

namespace drogue::perf {
namespace {

/// Record of five samples, s, with parts, whose error is 2e-3.
Record record(double seconds, bool passes) {
  Record made;
  made.samples.assign(5, seconds);
  made.error = 2e-3, made.tolerance = passes ? 1.0 : 1e-3;
  for (const char* part : {"h2d", "compute", "d2h"}) made.parts[part].assign(5, 0.25 * seconds);
  return made;
}

TEST(Rows, TransferOfAFailedRecordHasFailureInPlaceOfTimes) {
  const PrintedTimes printed{336.0, 118.0, 272.0, 726.0, 25376.0};
  const std::string passed = transfer_row("a", record(4e-6, true), printed, 2e-6);
  EXPECT_EQ(
      passed,
      "a        1.0 (336)             1.0 (118)             1.0 (272)             4.0 (726)             2.0 "
      "(25376)              2 (215)            0.5 (35)     [4.0 .. 4.0]                0.002  passed\n");
  const std::string failed = transfer_row("a", record(4e-6, false), printed, 2e-6);
  EXPECT_EQ(
      failed,
      "a          - (336)               - (118)               - (272)          FAILED (726)             2.0 "
      "(25376)              - (215)              - (35)                                 0.002  FAILED\n");
  EXPECT_EQ(failed.size(), passed.size());
}

TEST(Rows, TransferHeadingStandsAboveItsColumns) {
  const std::string heading = transfer_heading("a"),
                    row = transfer_row("a", record(4e-6, true), std::nullopt, 2e-6);
  const std::string columns = heading.substr(heading.find('\n') + 1);
  EXPECT_EQ(columns.find("total") + 5, row.find("4.0") + 3);
  EXPECT_EQ(columns.find("95 % of"), row.find('['));
  EXPECT_EQ(columns.find("error"), row.find("0.002"));
}

TEST(Rows, BlockOfAFailedRecordHasFailureInPlaceOfTime) {
  const Record fast = record(1e-6, true), wrong = record(1e-9, false), slow = record(2e-6, true);
  EXPECT_EQ(block_row(1024, {&fast, &wrong, &slow}, {0.5, 1.0, 0.25}),
            "      1024        1.00      FAILED        2.00  rho +1.00, p 0.500: occupancy does not explain "
            "the order");
  EXPECT_EQ(block_row(1024, {&wrong, &wrong}, {0.5, 1.0}), "      1024      FAILED      FAILED");
}

TEST(Rows, ScalingHasNoEfficiencyWithoutATimeOfOneUnit) {
  EXPECT_EQ(scaling_columns(record(1e-3, true), false, 2, 1e-3),
            "       1000.00  [1000.00 .. 1000.00]                50 %\n");
  EXPECT_EQ(scaling_columns(record(1e-3, true), false, 2, std::nullopt),
            "       1000.00  [1000.00 .. 1000.00]                   -\n");
  EXPECT_EQ(scaling_columns(record(1e-3, false), false, 2, 1e-3),
            "        FAILED  a check is 2 times its tolerance\n");
  EXPECT_EQ(speed_up_columns(2e-3, 1e-3, 4), "    2.00x        50 %\n");
  EXPECT_EQ(speed_up_columns(std::nullopt, 1e-3, 4), "        -           -\n");
}

TEST(Rows, ScalingShowsTheShareOfMessages) {
  EXPECT_EQ(
      scaling_columns(record(1e-3, true), false, 2, 1e-3,
                      MessageTimes{.measured = 2e-4, .modelled = 1e-4, .step = 6e-4}),
      "       1000.00  [1000.00 .. 1000.00]                50 %       200.00      20 %       100.00       "
      "600.00\n");
}

TEST(Rows, FailedRecordHasNeitherMedianNorInterval) {
  EXPECT_EQ(median_text(record(1e-3, true), 1e3, 4), "1.0000");
  EXPECT_EQ(interval_text(record(1e-3, true), 1e3, 4), "[1.0000 .. 1.0000]");
  EXPECT_EQ(median_text(record(1e-3, false), 1e3, 4), "FAILED");
  EXPECT_EQ(interval_text(record(1e-3, false), 1e3, 4), "");
}

}  // namespace
}  // namespace drogue::perf
