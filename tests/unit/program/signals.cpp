#include "common/program/signals.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace drogue {
namespace {

class Signals : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { clear_interrupt(); }
  void TearDown() override { clear_interrupt(); }
};

TEST_P(Signals, FirstSignalSetsInterrupted) {
  EXPECT_FALSE(interrupted());
  ASSERT_EQ(raise(GetParam()), 0);
  EXPECT_TRUE(interrupted());
  clear_interrupt();
  EXPECT_FALSE(interrupted());
  ASSERT_EQ(raise(GetParam()), 0);
  EXPECT_TRUE(interrupted());
}

TEST_P(Signals, SecondSignalEndsTheProcess) {
  const pid_t child = fork();
  if (child == 0) {
    raise(GetParam());
    raise(GetParam());
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Both, Signals, ::testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace drogue
