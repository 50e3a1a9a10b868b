#include "perf/compare/record_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/program/failure.hpp"
#include "common/run/files/temporary_folder.hpp"

namespace drogue::perf {
namespace {

const std::string good_record =
    R"({"schema":"drogue.perf/1","case":"a/b/1","unit":"s per step","samples":[1e-3,2e-3],"error":0.5,"check":"passed"})";

class RecordFile : public testing::Test {
 protected:
  std::vector<MeasuredCase> read(const std::string& content) {
    std::ofstream(_file) << content;
    return read_records(_file);
  }

  /// Exit code and sentence, without the folder of the file.
  std::string refusal(const std::string& content) {
    try {
      read(content);
    } catch (const Failure& failure) {
      return std::to_string(static_cast<int>(failure.code())) +
             std::string(failure.what()).substr(_file.size() - std::string("x.jsonl").size() - 1);
    }
    return "";
  }

  static std::string with(const std::string& old_text, const std::string& new_text) {
    std::string record = good_record;
    return record.replace(record.find(old_text), old_text.size(), new_text);
  }

 private:
  const run::TemporaryFolder _folder{"drogue-test"};
  std::string _file = (_folder.path() / "x.jsonl").string();
};

TEST_F(RecordFile, ReadsLinesWithOrWithoutALastLineEnd) {
  const std::vector<MeasuredCase> found = read(good_record + "\n\n" + with("0.5", "null"));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "a/b/1");
  EXPECT_EQ(found[0].samples, (std::vector{1e-3, 2e-3}));
  EXPECT_EQ(found[0].error, 0.5);
  EXPECT_TRUE(found[0].passed);
  EXPECT_FALSE(found[1].error.has_value());
  EXPECT_TRUE(found[1].place.ends_with("x.jsonl:3"));
}

TEST_F(RecordFile, RefusesLinesThatAreNoRecords) {
  EXPECT_EQ(refusal(""), "3/x.jsonl: the file holds no records");
  EXPECT_EQ(refusal("\n \n"), "3/x.jsonl: the file holds no records");
  EXPECT_EQ(refusal(good_record + "\n" + good_record.substr(0, 60)),
            "3/x.jsonl:2: the line ends within a record; is the file truncated?");
  EXPECT_EQ(refusal("time,price\n"), "3/x.jsonl:1: no JSON at column 2; is this a file of records?");
  EXPECT_EQ(refusal("[1]"), "3/x.jsonl:1: the line is no JSON object");
  for (const char* array : {"[", " [ {\"schema\":1},", "[{}]"})
    EXPECT_EQ(refusal(array),
              "3/x.jsonl:1: the file is a JSON array; records are JSON objects, one a line, as `jq -c .[]` "
              "writes them");
  EXPECT_EQ(refusal(R"({"time":1})"),
            "3/x.jsonl:1: no record of drogue-perf, which has a key 'schema' of 'drogue.perf/1'");
  EXPECT_EQ(refusal(good_record + "\n" + with("perf/1", "perf/2")),
            "3/x.jsonl:2: the schema is \"drogue.perf/2\"; this version reads \"drogue.perf/1\" alone");
}

TEST_F(RecordFile, RefusesSamplesThatAreNoTimes) {
  for (const char* sample : {"null", "0", "-1e-3", "\"1\"", "[]"})
    EXPECT_EQ(refusal(with("2e-3", sample)),
              "3/x.jsonl:1: samples[1] of a/b/1 is no positive finite number of seconds")
        << sample;
  EXPECT_EQ(refusal(with("2e-3", "1e999")), "3/x.jsonl:1: a number is too large");
  EXPECT_EQ(refusal(with("2e-3", "NaN")), "3/x.jsonl:1: NaN at column 78 is no number of JSON");
  EXPECT_EQ(refusal(with("2e-3", "-Infinity")), "3/x.jsonl:1: Infinity at column 79 is no number of JSON");
  EXPECT_EQ(refusal(with("[1e-3,2e-3]", "7")), "3/x.jsonl:1: 'samples' of a/b/1 is no list");
}

TEST_F(RecordFile, ReadsTheStateOfCaches) {
  const auto with_caches = [](const std::string& caches) {
    return with(R"("error")", R"("instrument":{"caches":)" + caches + R"(},"error")");
  };
  EXPECT_FALSE(read(good_record).front().cold_caches);
  EXPECT_FALSE(read(with_caches(R"("warm")")).front().cold_caches);
  EXPECT_TRUE(read(with_caches(R"("cold")")).front().cold_caches);
  EXPECT_EQ(refusal(with_caches("1")), "3/x.jsonl:1: 'caches' of a/b/1 is neither \"cold\" nor \"warm\"");
}

TEST_F(RecordFile, RefusesMissingAndWrongKeys) {
  EXPECT_EQ(refusal(with("\"samples\"", "\"sample\"")), "3/x.jsonl:1: the record has no 'samples'");
  EXPECT_EQ(refusal(with("\"a/b/1\"", "\"\"")), "3/x.jsonl:1: 'case' is no text");
  EXPECT_EQ(refusal(with("passed", "good")),
            "3/x.jsonl:1: 'check' of a/b/1 is neither \"passed\" nor \"failed\"");
  EXPECT_EQ(refusal(with("0.5", "\"0.5\"")), "3/x.jsonl:1: 'error' of a/b/1 is no number");
  EXPECT_EQ(refusal(with("\"check\"", "\"facts\":3,\"check\"")), "3/x.jsonl:1: 'facts' is no JSON object");
}

TEST_F(RecordFile, RefusesMissingFilesAndFolders) {
  const auto code = [](const std::string& file) {
    try {
      read_records(file);
    } catch (const Failure& failure) {
      return failure.code();
    }
    return ExitCode::ok;
  };
  EXPECT_EQ(code(testing::TempDir() + "missing.jsonl"), ExitCode::usage);
  EXPECT_EQ(code(testing::TempDir()), ExitCode::usage);
}

}  // namespace
}  // namespace drogue::perf
