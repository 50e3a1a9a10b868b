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

  std::string write(const std::string& name, const nlohmann::json& provenance) {
    nlohmann::json record = nlohmann::json::parse(
        R"({"schema":"drogue.perf/1","case":"a/b/1","unit":"s per step","samples":[1e-3],"error":0.5,"check":"passed"})");
    record["provenance"] = provenance;
    return write_text(name, record.dump() + "\n");
  }

  std::string write_text(const std::string& name, const std::string& text) {
    const std::string file = (_folder.path() / name).string();
    std::ofstream(file) << text;
    return file;
  }

  /// Name of the file in the folder, or the sentence of the refusal.
  std::string file_for(const nlohmann::json& provenance) {
    try {
      return std::filesystem::path(file_for_baseline(path(), provenance)).filename().string();
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

TEST_F(BaselineFolder, RefusesSeveralFilesOfOneMachineAndMissingFolders) {
  write("a.jsonl", machine("A"));
  write("b.jsonl", machine("A"));
  EXPECT_NE(file_for(machine("A")).find("has several baselines of one machine"), std::string::npos);
  try {
    static_cast<void>(file_for_baseline(path() + "/missing", machine("A")));
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
