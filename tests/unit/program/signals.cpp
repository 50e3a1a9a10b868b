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

class Notices : public Signals {};

/// A shell that ends sends SIGHUP as well as the terminal; a limit of processor time sends SIGXCPU every
/// second.
TEST_P(Notices, EveryOneSetsInterrupted) {
  for (int time = 0; time < 3; ++time) {
    ASSERT_EQ(raise(GetParam()), 0);
    EXPECT_TRUE(interrupted());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Notices, ::testing::Values(SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM));

/// nohup ignores SIGHUP, and the program starts so.
TEST(SignalsOfNohup, HangUpStaysIgnored) {
  std::signal(SIGHUP, SIG_IGN);
  install_signal_handlers();
  ASSERT_EQ(raise(SIGHUP), 0);
  EXPECT_FALSE(interrupted());
  std::signal(SIGHUP, SIG_DFL);
  clear_interrupt();
}

}  // namespace
}  // namespace drogue
