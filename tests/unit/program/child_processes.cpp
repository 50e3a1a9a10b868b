#include "common/program/child_processes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>

#include "common/program/signals.hpp"

namespace drogue {
namespace {

class ChildProcesses : public ::testing::Test {
 protected:
  void SetUp() override {
    clear_interrupt();
    std::filesystem::create_directories(_folder);
  }
  void TearDown() override {
    clear_interrupt();
    std::filesystem::remove_all(_folder);
  }

  [[nodiscard]] ChildProcess shell(const std::string& script, const std::string& log = "log") const {
    return {"/bin/sh", {"sh", "-c", script}, {{"DROGUE_CHILD", "of a test"}}, _folder / log};
  }
  [[nodiscard]] std::string text(const std::string& log = "log") const {
    std::ifstream stream(_folder / log);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::filesystem::path _folder =
      std::filesystem::temp_directory_path() / ("children" + std::to_string(::getpid()));
  std::vector<int> _codes = std::vector<int>(8, -1);
  const std::function<void(std::size_t, int)> _ended = [this](std::size_t i, int code) {
    _codes.at(i) = code;
  };
};

TEST_F(ChildProcesses, ReportCodesSignalsAndOutput) {
  EXPECT_TRUE(run_processes(
      {shell("echo $DROGUE_CHILD; echo error >&2; exit 5"), shell("kill -9 $$", "other")}, 2, _ended));
  EXPECT_EQ(_codes[0], 5);
  EXPECT_EQ(_codes[1], 128 + SIGKILL);
  EXPECT_EQ(text(), "of a test\nerror\n");
}

TEST_F(ChildProcesses, RunAsManyAtOnceAsAreAllowed) {
  // Each waits for the file of the other: alone, neither could end.
  const auto meet = [&](const std::string& own, const std::string& other) {
    return shell(
        "cd " + _folder.string() + "; touch " + own + "; while [ ! -e " + other + " ]; do sleep 0.01; done",
        own + ".log");
  };
  EXPECT_TRUE(run_processes({meet("a", "b"), meet("b", "a")}, 2, _ended));
  EXPECT_EQ(_codes[1], 0);
  // In order, one at a time.
  const std::string file = (_folder / "order").string();
  EXPECT_TRUE(run_processes({shell("sleep 0.1; echo 1 >> " + file), shell("echo 2 >> " + file)}, 1, _ended));
  EXPECT_EQ(text("order"), "1\n2\n");
}

TEST_F(ChildProcesses, EndOnASignalAndNoMoreStart) {
  // The first one asks this process to end, and ends at the signal that it then receives.
  const std::string parent = std::to_string(::getpid());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(
      run_processes({shell("trap 'exit 130' INT; kill -INT " + parent + "; while :; do sleep 0.02; done"),
                     shell("exit 0", "other")},
                    1, _ended));
  EXPECT_EQ(_codes[0], 130);
  EXPECT_EQ(_codes[1], -1) << "was not started";
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(ChildProcesses, ThatDoNotExistFail) {
  EXPECT_TRUE(run_processes({{"/no/such/program", {"program"}, {}, _folder / "log"}}, 1, _ended));
  EXPECT_NE(_codes[0], 0);
}

TEST_F(ChildProcesses, KnowTheirProgram) { EXPECT_TRUE(std::filesystem::exists(this_program())); }

}  // namespace
}  // namespace drogue
