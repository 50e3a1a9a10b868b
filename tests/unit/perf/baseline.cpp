#include "perf/compare/baseline.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/program/failure.hpp"
#include "common/run/files/temporary_folder.hpp"

namespace drogue::perf {
namespace {

class BaselineFolder : public testing::Test {
 protected:
  static nlohmann::json machine(const std::string& cpu, const std::string& gpu = "") {
    return {{"cpu", cpu}, {"gpu", gpu}, {"threads", 2}, {"git", "abc"}, {"date", "2026-11-20T12:00:00Z"}};
  }

  static std::string line_of(const std::string& name, const nlohmann::json& provenance) {
    nlohmann::json record = nlohmann::json::parse(
        R"({"schema":"drogue.perf/1","unit":"s per step","samples":[1e-3],"error":0.5,"check":"passed"})");
    record["case"] = name;
    record["provenance"] = provenance;
    return record.dump() + "\n";
  }

  std::string write(const std::string& name, const nlohmann::json& provenance) {
    return write_text(name, line_of("a/b/1", provenance));
  }

  std::string write_text(const std::string& name, const std::string& text) {
    const std::string file = (_folder.path() / name).string();
    std::ofstream(file) << text;
    return file;
  }

  /// Name of the file in the folder, or the sentence of the refusal.
  std::string file_for(const nlohmann::json& provenance) {
    try {
      return std::filesystem::path(file_for_baseline(path(), provenance, {"a/b/1"}, false).file)
          .filename()
          .string();
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::usage);
      return failure.what();
    }
  }

  std::string path() const { return _folder.path().string(); }

 private:
  const run::TemporaryFolder _folder{"drogue-test"};
};

TEST_F(BaselineFolder, NamesNewFilesByTheMachine) {
  EXPECT_EQ(file_for(machine("AMD EPYC(tm) 7B13 ")), "amd-epyc-tm-7b13-2.jsonl");
  EXPECT_EQ(file_for(machine("A", "NVIDIA H200")), "nvidia-h200-2.jsonl");
  write("nvidia-h200-2.jsonl", machine("another processor", "NVIDIA H200"));
  EXPECT_EQ(file_for(machine("A", "NVIDIA H200")), "nvidia-h200-2-2.jsonl");
  EXPECT_EQ(file_for(machine("")), "machine-2.jsonl");
}

TEST_F(BaselineFolder, ReplacesTheFileOfTheMachineAndNamesItsAge) {
  write("mine.jsonl", machine("A"));
  write("other.jsonl", machine("B"));
  write_text("broken.jsonl", "{");
  nlohmann::json now = machine("A");
  now["date"] = "2026-11-23T12:00:00Z";
  testing::internal::CaptureStdout();
  EXPECT_EQ(file_for(now), "mine.jsonl");
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_NE(printed.find("mine.jsonl replaces that of commit abc, date 2026-11-20T12:00:00Z; 3.0 days later"),
            std::string::npos)
      << printed;
  EXPECT_NE(printed.find("left out: " + path() + "/broken.jsonl:1: the line ends"), std::string::npos)
      << printed;
}

TEST_F(BaselineFolder, KeepsOtherCasesWithTheirAge) {
  nlohmann::json old = machine("A"), now = machine("A");
  old["date"] = "2026-11-01T12:00:00Z", old["git"] = "old";
  now["date"] = "2026-11-23T12:00:00Z";
  const std::string kept = line_of("c", machine("A")), older = line_of("d", old);
  write_text("mine.jsonl", line_of("a/b/1", machine("A")) + older + kept + line_of("a/b/1", machine("A")));
  testing::internal::CaptureStdout();
  const BaselineFile others = file_for_baseline(path(), now, {"a/b/1"}, true);
  const std::string printed = testing::internal::GetCapturedStdout();
  ASSERT_EQ(others.kept.size(), 2U);
  EXPECT_EQ(others.kept[0].dump() + "\n", older);
  EXPECT_EQ(others.kept[1].dump() + "\n", kept);
  EXPECT_NE(printed.find("mine.jsonl: replaces 2 records of commit abc, date 2026-11-20T12:00:00Z; 3.0 days "
                         "later\n"),
            std::string::npos)
      << printed;
  EXPECT_NE(printed.find("mine.jsonl: keeps 2 records of other cases, of commit old, date "
                         "2026-11-01T12:00:00Z, to commit abc, date 2026-11-20T12:00:00Z; 22.0 days later\n"),
            std::string::npos)
      << printed;
  EXPECT_TRUE(file_for_baseline(path(), now, {"a/b/1"}, false).kept.empty());
  EXPECT_EQ(file_for_baseline(path(), now, {"new"}, true).kept.size(), 4U);
}

TEST_F(BaselineFolder, AgeIsThatOfTheOldestRecordOfKnownDate) {
  std::vector<MeasuredCase> before(3);
  MeasuredCase after;
  before[0].provenance = machine("A");
  before[1].provenance = before[2].provenance = after.provenance = machine("A");
  before[0].provenance.erase("date");
  before[1].provenance["date"] = "2026-10-01T12:00:00Z";
  EXPECT_EQ(describe_origin(before),
            "commit abc, date 2026-10-01T12:00:00Z, to commit abc, date 2026-11-20T12:00:00Z");
  EXPECT_EQ(describe_age(before, after),
            "; 50.0 days later; measure the old commit again before a verdict matters");
}

TEST_F(BaselineFolder, RefusesSeveralFilesOfOneMachineAndMissingFolders) {
  write("a.jsonl", machine("A"));
  write("b.jsonl", machine("A"));
  EXPECT_NE(file_for(machine("A")).find("has several baselines of one machine"), std::string::npos);
  try {
    static_cast<void>(file_for_baseline(path() + "/missing", machine("A"), {"a/b/1"}, false));
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::usage);
  }
}

TEST_F(BaselineFolder, FindsTheBaselineBesideBrokenFiles) {
  const std::string mine = write("z.jsonl", machine("A"));
  write_text("a.jsonl", "no JSON\n");
  write_text("b.jsonl", "");
  MeasuredCase now;
  now.provenance = machine("A");
  const Baseline found = find_baseline(path(), now);
  EXPECT_EQ(found.file, mine);
  ASSERT_EQ(found.broken.size(), 2U);
  EXPECT_NE(found.broken[0].find("a.jsonl:1: no JSON"), std::string::npos);
  EXPECT_NE(found.broken[1].find("b.jsonl: the file holds no records"), std::string::npos);
  EXPECT_TRUE(find_baseline(mine, now).broken.empty());
}

}  // namespace
}  // namespace drogue::perf
