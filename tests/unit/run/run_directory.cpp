#include "common/run/run_directory.hpp"

#include <gtest/gtest.h>

#include "common/run/files/atomic_file.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

TEST(RunDirectory, CreatesTheDirectoryAndItsParents) {
  const TemporaryDirectory parent;
  const RunDirectory run(parent / "out/sod", ExistingRun::refuse);
  run.write_scene("app = \"gas\"\n");
  EXPECT_EQ(content(parent / "out/sod/scene.toml"), "app = \"gas\"\n");
}

TEST(RunDirectory, IgnoresForeignFiles) {
  const TemporaryDirectory parent;
  write_file_atomically(parent / "notes.txt", "mine");
  EXPECT_NO_THROW(RunDirectory(parent.path(), ExistingRun::refuse));
  EXPECT_EQ(parent.entries(), 1U) << "the lock was left behind";
}

TEST(RunDirectory, RefusesAFormerRunAsUsageError) {
  const TemporaryDirectory parent;
  write_file_atomically(parent / "history.csv", "time [s]\n");
  const std::string sentence =
      failure_of(ExitCode::usage, [&parent] { const RunDirectory run(parent.path(), ExistingRun::refuse); });
  EXPECT_NE(sentence.find("--overwrite"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(parent.path().string()), std::string::npos) << sentence;
  EXPECT_EQ(content(parent / "history.csv"), "time [s]\n");
}

TEST(RunDirectory, OverwriteRemovesKnownNamesOnly) {
  const TemporaryDirectory parent;
  for (const std::string& name : run_file_names()) write_file_atomically(parent / name, "former");
  write_file_atomically(parent / ".result.json.77.tmp", "left by a kill");
  std::vector<std::string> pictures = {"space_time_rho.png", "fields.gif", "fields.mp4", "history.pdf",
                                       ".fields.77.gif"};
  for (const std::string& name : picture_names()) pictures.push_back(name + ".png");
  for (const std::string& name : pictures) write_file_atomically(parent / name, "former");
  const std::vector<std::string> foreign = {"notes.txt",      ".mine.tmp",     "photo.png",
                                            "fields.png.bak", "my-fields.png", ".fields.old.png",
                                            ".photo.77.png",  "profiles.txt"};
  for (const std::string& name : foreign) write_file_atomically(parent / name, "mine");
  RunDirectory run(parent.path(), ExistingRun::overwrite);
  run.begin();
  EXPECT_FALSE(holds_run(parent.path()));
  EXPECT_FALSE(std::filesystem::exists(parent / ".result.json.77.tmp"));
  for (const std::string& name : pictures) EXPECT_FALSE(std::filesystem::exists(parent / name)) << name;
  for (const std::string& name : foreign) EXPECT_TRUE(std::filesystem::exists(parent / name)) << name;
}

TEST(RunDirectory, AdvisesRestartOnlyWhereARunHasIt) {
  const TemporaryDirectory parent;
  write_file_atomically(parent / "study.csv", "former");
  for (const auto existing : {ExistingRun::refuse, ExistingRun::refuse_study}) {
    const std::string sentence =
        failure_of(ExitCode::usage, [&parent, existing] { const RunDirectory run(parent.path(), existing); });
    EXPECT_NE(sentence.find("--overwrite"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find("--restart") != std::string::npos, existing == ExistingRun::refuse) << sentence;
  }
}

TEST(RunDirectory, ResumeKeepsTheFormerRun) {
  const TemporaryDirectory parent;
  write_file_atomically(parent / "restart.h5", "state");
  write_file_atomically(parent / "result.json", "of the former end");
  for (const char* picture : {"history.png", "fields.gif"}) write_file_atomically(parent / picture, "former");
  RunDirectory run(parent.path(), ExistingRun::resume);
  EXPECT_EQ(run.begin(), (std::vector<std::string>{"fields.gif", "history.png"}));
  EXPECT_EQ(content(parent / "restart.h5"), "state");
  EXPECT_FALSE(std::filesystem::exists(parent / "result.json"));
}

TEST(RunDirectory, RefusesADirectoryInUse) {
  const TemporaryDirectory parent;
  const auto second = [&parent] { const RunDirectory run(parent.path(), ExistingRun::overwrite); };
  {
    const RunDirectory first(parent.path(), ExistingRun::refuse);
    first.write_scene("first");
    const std::string sentence = failure_of(ExitCode::io_error, second);
    EXPECT_NE(sentence.find("in use by another process"), std::string::npos) << sentence;
    EXPECT_EQ(content(parent / "scene.toml"), "first");
  }
  EXPECT_NO_THROW(second()) << "the lock outlived its run";
}

TEST(RunDirectory, ReleasesTheDirectoryAfterAKill) {
  const TemporaryDirectory parent;
  const int status = test::in_child([&parent] {
    const RunDirectory run(parent.path(), ExistingRun::refuse);
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(std::filesystem::exists(parent / ".lock")) << "the child had no lock";
  EXPECT_NO_THROW(RunDirectory(parent.path(), ExistingRun::refuse));
}

TEST(RunDirectory, ThrowsIoErrorForAnInvalidPath) {
  const TemporaryDirectory parent;
  write_file_atomically(parent / "file", "");
  const std::string below_a_file = failure_of(
      ExitCode::io_error, [&parent] { const RunDirectory run(parent / "file/out", ExistingRun::refuse); });
  EXPECT_NE(below_a_file.find("file/out': Not a directory"), std::string::npos) << below_a_file;
}

// The kernel refuses files in its own directories even for root.
TEST(RunDirectory, ThrowsIoErrorForAReadOnlyFolder) {
  if (!std::filesystem::exists("/proc/self")) GTEST_SKIP() << "needs /proc";
  const std::string read_only =
      failure_of(ExitCode::io_error, [] { const RunDirectory run("/proc/drogue", ExistingRun::refuse); });
  EXPECT_NE(read_only.find("cannot create the run directory '/proc/drogue'"), std::string::npos) << read_only;
  const std::string existing =
      failure_of(ExitCode::io_error, [] { const RunDirectory run("/proc/self", ExistingRun::refuse); });
  EXPECT_NE(existing.find("cannot write to the run directory '/proc/self'"), std::string::npos) << existing;
}

TEST(RunDirectory, RestartSourceFindsTheNamedOrOwnFile) {
  const TemporaryDirectory parent;
  EXPECT_EQ(restart_source("auto", parent.path()), "");
  write_file_atomically(parent / "restart.h5", "state");
  EXPECT_EQ(restart_source("auto", parent.path()), parent / "restart.h5");
  EXPECT_EQ(restart_source((parent / "restart.h5").string(), "elsewhere"), parent / "restart.h5");
  const std::string sentence = failure_of(ExitCode::usage, [] { restart_source("none.h5", "."); });
  EXPECT_NE(sentence.find("'none.h5' does not exist"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace drogue::run
