#include "perf/report/exports.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

MeasuredCase exported(const std::string& name, bool passed) {
  MeasuredCase made;
  made.name = name, made.unit = "s per step", made.samples = {2.0, 1.0, 4.0}, made.error = 0.5,
  made.passed = passed;
  made.facts = {{"backend", "cuda"}, {"cells", 8}};
  made.provenance = {
      {"cpu", "a, b"}, {"gpu", "g"}, {"threads", 2}, {"compiler", "c"}, {"date", "2026-01-02T00:00:00Z"}};
  return made;
}

TEST(Exports, CsvQuotesFieldsAndLeavesUnknownOnesEmpty) {
  MeasuredCase computed = exported("x", false);
  computed.samples.clear(), computed.error.reset(), computed.facts = nlohmann::json::object();
  computed.cold_caches = true;
  EXPECT_EQ(to_csv({exported("a/b", true), computed}),
            "case,unit,median,low,high,samples,least,largest,error,check,backend,cells,variant,cpu,gpu,"
            "threads,flags,git,date,caches\n"
            "a/b,s per step,2,1,4,3,1,4,0.5,passed,cuda,8,,\"a, b\",g,2,,,2026-01-02T00:00:00Z,warm\n"
            "x,s per step,,,,0,,,,failed,,,,\"a, b\",g,2,,,2026-01-02T00:00:00Z,cold\n");
}

TEST(Exports, ReframeReportHoldsATestCasePerRecord) {
  MeasuredCase cold = exported("b", false);
  cold.cold_caches = true;
  const nlohmann::json report = nlohmann::json::parse(to_reframe({exported("a", true), cold}));
  EXPECT_EQ(report["session_info"]["num_cases"], 2);
  EXPECT_EQ(report["session_info"]["num_failures"], 1);
  const nlohmann::json& cases = report["runs"][0]["testcases"];
  EXPECT_EQ(cases[0]["display_name"], "a");
  EXPECT_EQ(cases[1]["display_name"], "b with cold caches");
  EXPECT_EQ(cases[0]["result"], "pass");
  EXPECT_EQ(cases[1]["result"], "fail");
  EXPECT_EQ(cases[0]["system"], "a, b, g");
  EXPECT_EQ(cases[0]["perfvars"][0]["value"], 2.0);
  EXPECT_EQ(cases[0]["perfvars"][0]["unit"], "s per step");
}

}  // namespace
}  // namespace drogue::perf
