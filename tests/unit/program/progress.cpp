#include "common/program/progress.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace drogue {
namespace {

/// Pseudo terminal: text() returns the output to `stream`.
class Terminal {
 public:
  Terminal() : _master(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (grantpt(_master) == 0 && unlockpt(_master) == 0)
      stream = fdopen(open(ptsname(_master), O_RDWR | O_NOCTTY), "w");
  }
  ~Terminal() {
    if (stream != nullptr) std::fclose(stream);
    close(_master);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] std::string text() const {
    std::string all;
    pollfd readable = {_master, POLLIN, 0};
    char buffer[4096];
    while (poll(&readable, 1, 50) == 1) {
      const ssize_t count = read(_master, buffer, sizeof buffer);
      if (count <= 0) break;
      all.append(buffer, static_cast<std::size_t>(count));
    }
    return all;
  }

  std::FILE* stream = nullptr;

 private:
  int _master;
};

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t i = text.find(word); i != std::string::npos; i = text.find(word, i + 1)) ++count;
  return count;
}

TEST(Progress, ShowsStepTimeRateAndEta) {
  EXPECT_EQ(progress_text(500, 500, 0.1, 0.0, 0.4, 2.0), "step 500  t 0.1/0.4 (25 %)  250 steps/s  ETA 0:06");
  // A continued run: the rate counts its own steps only.
  EXPECT_EQ(progress_text(600, 100, 0.3, 0.2, 0.4, 3725.0),
            "step 600  t 0.3/0.4 (75 %)  0.02685 steps/s  ETA 1:02:05");
  EXPECT_EQ(progress_text(0, 0, 0.0, 0.0, 0.4, 0.0), "step 0  t 0/0.4 (0 %)  0 steps/s  ETA -");
}

TEST(Progress, UpdatesOneTerminalLineAFewTimesPerSecond) {
  const Terminal terminal;
  if (terminal.stream == nullptr) GTEST_SKIP() << "needs pseudo terminals";
  std::string text;
  {
    ProgressLine line(false, terminal.stream);
    for (int step = 0; step < 1000; ++step) line.update(step, 0.001 * step, 1.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    line.update(1000, 1.0, 1.0);
    text = terminal.text();
  }
  EXPECT_NE(text.find("step 1000"), std::string::npos) << text;
  EXPECT_LE(occurrences(text, "step"), 8U)
      << text;  // two lines of two such words, and room for a slow machine
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(terminal.text(), "\r\x1b[K") << "the line must be removed at the end";
}

TEST(Progress, ShowsNothingIfQuiet) {
  const Terminal terminal;
  if (terminal.stream == nullptr) GTEST_SKIP() << "needs pseudo terminals";
  ProgressLine(true, terminal.stream).update(1, 0.1, 1.0);
  EXPECT_EQ(terminal.text(), "");
}

TEST(Progress, ShowsNothingInAPipe) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  ProgressLine(false, file).update(1, 0.1, 1.0);
  std::fflush(file);
  EXPECT_EQ(std::ftell(file), 0);
  std::fclose(file);
}

}  // namespace
}  // namespace drogue
