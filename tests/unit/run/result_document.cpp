#include "common/run/result_document.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/run/files/atomic_file.hpp"
#include "common/version.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using Json = nlohmann::json;

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

TEST(ResultDocument, HoldsEveryFieldOfTheSchema) {
  ResultDocument result;
  result.add_check("l1_density", 1e-3, 2e-3);
  result.metrics.add_group("counts");
  result.metrics.set("energy", "kinetic", 2.0);
  result.metrics.set("limiter", "touches", std::int64_t{3});
  const Json json = Json::parse(to_json(result));
  EXPECT_EQ(json["schema"], "drogue.result/1");
  EXPECT_EQ(keys(json),
            sorted({"schema", "program",   "version",    "git",        "scene",  "backend",   "device",
                    "driver", "precision", "ranks",      "threads",    "status", "exit_code", "message",
                    "steps",  "time",      "dt_min",     "dt_max",     "errors", "checks",    "limiter",
                    "timing", "ledger",    "peak_bytes", "provenance", "energy"}));
  EXPECT_EQ(json["energy"]["kinetic"], 2.0);
  EXPECT_EQ(json["limiter"]["touches"].dump(), "3");
  EXPECT_EQ(keys(json["checks"][0]), sorted({"name", "value", "tolerance", "passed"}));
  EXPECT_EQ(keys(json["timing"]),
            sorted({"wall_s", "setup_s", "compute_s", "h2d_s", "d2h_s", "io_s", "bound_s", "verify_s"}));
  EXPECT_EQ(keys(json["ledger"]), sorted({"kernel_launches", "fences", "device_allocations_after_warmup",
                                          "h2d_bytes", "d2h_bytes"}));
  EXPECT_EQ(keys(json["peak_bytes"]), sorted({"host", "device"}));
  EXPECT_EQ(keys(json["provenance"]),
            sorted({"compiler", "flags", "kokkos", "cpu", "gpu", "driver", "date"}));
  EXPECT_TRUE(json["errors"].is_object());
}

TEST(ResultDocument, StatesRowsOfChecksAndWarnsOfFew) {
  ResultDocument result;
  result.add_check("of_the_end", 0.0, 1.0);
  for (const auto& [rows, period] :
       {std::pair{200U, 0.0}, {200U, 8.5}, {200U, std::nan("")}, {9U, 0.0}, {200U, 7.5}}) {
    result.add_check("of_rows", 0.0, 1.0);
    result.state_rows(rows, period);
  }
  const Json json = Json::parse(to_json(result));
  EXPECT_FALSE(json["checks"][0].contains("rows"));
  EXPECT_EQ(json["checks"][1]["rows"], 200);
  EXPECT_EQ(json["checks"][4]["rows"], 9);
  ASSERT_EQ(json["warnings"].size(), 2U);
  EXPECT_EQ(
      json["warnings"][0].get<std::string>().find("of_rows is computed from 9 rows of history.csv, which"),
      0U);
  EXPECT_EQ(json["warnings"][1].get<std::string>().find(
                "of_rows is computed from 7.5 rows of history.csv in a period"),
            0U);
}

TEST(ResultDocument, WritesMetricGroupsInOrderBetweenChecksAndTiming) {
  ResultDocument result;
  result.metrics.add_group("second_later");
  result.metrics.set("first", "b", 1.0);
  result.metrics.set("first", "a", std::int64_t{2});
  result.metrics.set("second_later", "c", std::nan(""));
  result.metrics.set("first", "b", 4.0);
  result.metrics.set("first", "solver", std::string("fft"));
  const auto json = nlohmann::ordered_json::parse(to_json(result));
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  const auto checks = std::ranges::find(names, "checks");
  EXPECT_EQ(std::vector<std::string>(checks, checks + 4),
            (std::vector<std::string>{"checks", "second_later", "first", "timing"}));
  EXPECT_EQ(json["first"].dump(), R"({"b":4.0,"a":2,"solver":"fft"})");
  EXPECT_TRUE(json["second_later"]["c"].is_null());
  EXPECT_EQ(result.metrics.integer("first", "a"), 2);
  EXPECT_EQ(result.metrics.integer("first", "b"), 4);
  EXPECT_EQ(result.metrics.integer("first", "solver"), 0);
  EXPECT_EQ(result.metrics.integer("first", "absent"), 0);
}

TEST(ResultDocument, KeepsValuesExactly) {
  ResultDocument result;
  result.scene = "sod";
  result.steps = 1'234'567'890'123;
  result.time = 0.1;
  result.dt_min = 1e-17;
  result.errors["l1_density"] = 1.0 / 3.0;
  result.ledger.h2d_bytes = 7;
  const Json json = Json::parse(to_json(result));
  EXPECT_EQ(json["scene"], "sod");
  EXPECT_EQ(json["steps"], 1'234'567'890'123);
  EXPECT_EQ(json["time"].get<double>(), 0.1);
  EXPECT_EQ(json["dt_min"].get<double>(), 1e-17);
  EXPECT_EQ(json["errors"]["l1_density"].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(json["ledger"]["h2d_bytes"], 7);
}

TEST(ResultDocument, WritesNonFiniteNumbersAsNull) {
  ResultDocument result;
  result.dt_max = std::numeric_limits<double>::infinity();
  result.errors["l1_density"] = std::nan("");
  const Json json = Json::parse(to_json(result));
  EXPECT_TRUE(json["dt_max"].is_null());
  EXPECT_TRUE(json["errors"]["l1_density"].is_null());
}

TEST(ResultDocument, ReplacesInvalidUtf8) {
  ResultDocument result;
  result.message = "file '\xff\xfe\"' is not there";
  EXPECT_NE(Json::parse(to_json(result))["message"].get<std::string>().find("is not there"),
            std::string::npos);
}

TEST(ResultDocument, NamesTheStatusOfEveryExitCode) {
  const std::vector<std::pair<ExitCode, std::string>> names = {
      {ExitCode::ok, "ok"},
      {ExitCode::usage, "invalid"},
      {ExitCode::invalid_scene, "invalid"},
      {ExitCode::numerical_failure, "numerical-failure"},
      {ExitCode::verification_failed, "verification-failed"},
      {ExitCode::io_error, "io-error"},
      {ExitCode::interrupted, "interrupted"},
      {ExitCode::no_backend, "no-backend"},
  };
  for (const auto& [code, name] : names) {
    ResultDocument result;
    result.exit_code = code;
    const Json json = Json::parse(to_json(result));
    EXPECT_EQ(json["status"], name);
    EXPECT_EQ(json["exit_code"], static_cast<int>(code));
  }
}

TEST(ResultDocument, ChecksPassUpToTheirTolerance) {
  ResultDocument result;
  EXPECT_TRUE(result.add_check("at the tolerance", -2.0, 2.0));
  EXPECT_EQ(result.failed_check(), "");
  EXPECT_FALSE(result.add_check("above", 2.5, 2.0));
  EXPECT_FALSE(result.add_check("not a number", std::nan(""), 2.0));
  EXPECT_EQ(result.failed_check(), "above is 2.5, above its tolerance 2");
}

TEST(ResultDocument, ChecksReportTheirMeasurements) {
  ResultDocument result;
  result.add_check("force", 0.5, 1.0, Measurement{2.5, 1.0, 3.0});
  result.add_check("energy", 0.5, 1.0);
  EXPECT_EQ(result.checks[0].measured(), "2.5 in [1, 3]");
  EXPECT_EQ(result.checks[1].measured(), "");
  result.add_check("speed", 1.5, 1.0, Measurement{0.5, 1.0, 3.0});
  EXPECT_EQ(result.failed_check(),
            "speed is 0.5, not in [1, 3]: its deviation is 1.5, above its tolerance 1");
  result.add_check("narrow", 0.0, 1e-9, Measurement{19.2, 19.2 - 1.92e-8, 19.2 + 1.92e-8});
  EXPECT_EQ(result.checks[3].measured(), "19.2 in [19.199999981, 19.200000019]");
  result.add_check("drag", std::nan(""), 1.0, Measurement{std::nan(""), 1.0, 3.0});
  EXPECT_EQ(result.checks[4].measured(), "not measured");
}

TEST(ResultDocument, DeviationsAreRelativeUnlessFromZero) {
  ResultDocument result;
  result.add_deviation("force", -0.32, -0.3, 0.1);
  result.add_deviation("drag", 0.5, 0.3, 0.1);
  result.add_deviation("lift", -0.5, 0.0, 0.1);
  result.add_distance("place", 2.5, 2.0, 1.0);
  EXPECT_NEAR(result.checks[0].value, 0.02 / 0.3, 1e-15);
  EXPECT_EQ(result.checks[0].tolerance, 0.1);
  EXPECT_EQ(result.checks[0].measured(), "-0.32 in [-0.33, -0.27]");
  EXPECT_EQ(result.checks[1].measured(), "0.5, not in [0.27, 0.33]");
  EXPECT_EQ(result.checks[2].value, 0.5);
  EXPECT_EQ(result.checks[2].measured(), "-0.5, not in [-0.1, 0.1]");
  EXPECT_EQ(result.checks[3].value, 0.5);
  EXPECT_EQ(result.checks[3].measured(), "2.5 in [1, 3]");
  const Json json = Json::parse(to_json(result));
  EXPECT_EQ(json["checks"][1]["measured"], 0.5);
}

TEST(ResultDocument, KnowsTheResultOfAFinishedRun) {
  const test::TemporaryDirectory directory;
  const auto file = directory / "result.json";
  EXPECT_FALSE(time_of_finished_run(file));
  for (const auto& [code, finished] :
       {std::pair{ExitCode::ok, true}, std::pair{ExitCode::verification_failed, true},
        std::pair{ExitCode::interrupted, false}, std::pair{ExitCode::io_error, false}}) {
    ResultDocument result = new_result("drogue-gas", "sod");
    result.exit_code = code;
    write_result(file, result);
    EXPECT_EQ(time_of_finished_run(file).has_value(), finished) << status_name(code);
  }
  write_file_atomically(file, "{ \"status\": \"o");
  EXPECT_FALSE(time_of_finished_run(file));
}

TEST(ResultDocument, HoldsBuildFactsAndPeakMemory) {
  const test::TemporaryDirectory directory;
  write_result(directory / "result.json", new_result("drogue-gas", "sod"));
  const Json json = Json::parse(test::content(directory / "result.json"));
  EXPECT_EQ(json["program"], "drogue-gas");
  EXPECT_EQ(json["version"], build_info().version);
  EXPECT_FALSE(json["provenance"]["cpu"].get<std::string>().empty());
  EXPECT_EQ(json["provenance"]["date"].get<std::string>().size(), 20U);
  EXPECT_GT(json["peak_bytes"]["host"].get<std::int64_t>(), 1'000'000);
}

}  // namespace
}  // namespace drogue::run
