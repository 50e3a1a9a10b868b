#include "common/run/history_writer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "common/run/files/atomic_file.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

const std::vector<Column> columns = {{"energy", "J"}, {"contacts", ""}};

void append(HistoryWriter& history, double time, double energy, double contacts) {
  history.append(time, std::array{energy, contacts});
}

TEST(HistoryWriter, WritesHeaderWithUnitsAndRowsThatReadBackEqual) {
  const TemporaryDirectory directory;
  HistoryWriter history(directory / "history.csv", columns);
  append(history, 0.1, 1.0 / 3.0, 2.0);
  history.finish();
  const std::string text = content(directory / "history.csv");
  EXPECT_EQ(text, "time [s],energy [J],contacts\n0.1,0.3333333333333333,2\n");
  EXPECT_EQ(std::strtod(text.c_str() + text.find("0.333"), nullptr), 1.0 / 3.0);
}

TEST(HistoryWriter, KeepsRowsWhenAnExceptionUnwinds) {
  const TemporaryDirectory directory;
  EXPECT_THROW(
      {
        HistoryWriter history(directory / "history.csv", columns);
        append(history, 0.5, 1.0, 0.0);
        throw Failure(ExitCode::numerical_failure, "negative density");
      },
      Failure);
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n0.5,1,0\n");
}

TEST(HistoryWriter, ReportsAFileThatWasDeletedOrReplaced) {
  for (const bool replaced : {false, true}) {
    const TemporaryDirectory directory;
    HistoryWriter history(directory / "history.csv", columns);
    append(history, 0.5, 1.0, 0.0);
    history.flush();
    std::filesystem::remove(directory / "history.csv");
    if (replaced) write_file_atomically(directory / "history.csv", "another");
    append(history, 0.6, 1.0, 0.0);
    EXPECT_NO_THROW(history.flush());  // the run goes on to its restart file
    const std::string sentence = failure_of(ExitCode::io_error, [&] { history.finish(); });
    EXPECT_TRUE(sentence.ends_with("history.csv' was deleted or replaced during the run")) << sentence;
  }
}

TEST(HistoryWriter, KeepsFlushedRowsAfterAKill) {
  const TemporaryDirectory directory;
  const int status = test::in_child([&directory] {
    HistoryWriter history(directory / "history.csv", columns);
    append(history, 0.5, 1.0, 0.0);
    history.flush();
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n0.5,1,0\n");
}

TEST(HistoryWriter, ContinuesWithoutLaterAndTornRows) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "history.csv",
                        "time [s],energy [J],contacts\n0.1,1,0\n0.2,2,0\n0.3,3,0\n0.4,4");
  HistoryWriter history(directory / "history.csv", columns, 0.2);
  append(history, 0.25, 9.0, 1.0);
  history.finish();
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n0.1,1,0\n0.2,2,0\n0.25,9,1\n");
}

TEST(HistoryWriter, DropsATornRowThatLooksWhole) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "history.csv", "time [s],energy [J],contacts\n0.1,1,0\n0.2,2");
  HistoryWriter(directory / "history.csv", columns, 0.2).finish();
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n0.1,1,0\n");
}

TEST(HistoryWriter, BeginsAFileIfARestartFindsNone) {
  const TemporaryDirectory directory;
  HistoryWriter(directory / "history.csv", columns, 0.2).finish();
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n");
}

TEST(HistoryWriter, RefusesToContinueOtherColumns) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "history.csv", "time [s],mass [kg]\n0.1,1\n");
  const std::string sentence = failure_of(ExitCode::io_error, [&directory] {
    const HistoryWriter history(directory / "history.csv", columns, 0.2);
  });
  EXPECT_NE(sentence.find("other columns"), std::string::npos) << sentence;
  EXPECT_EQ(content(directory / "history.csv"), "time [s],mass [kg]\n0.1,1\n");
  EXPECT_EQ(failure_of(ExitCode::io_error,
                       [&directory] { require_same_columns(directory / "history.csv", columns); }),
            sentence);
  EXPECT_NO_THROW(require_same_columns(directory / "absent.csv", columns));
}

TEST(HistoryWriter, ReplacesTheRowsOfAFormerRun) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "history.csv", "time [s],mass [kg]\n0.1,1\n");
  HistoryWriter(directory / "history.csv", columns).finish();
  EXPECT_EQ(content(directory / "history.csv"), "time [s],energy [J],contacts\n");
}

TEST(HistoryWriter, ThrowsOnAFullDisk) {
  const TemporaryDirectory directory;
  const int status = test::in_child([&directory] {
    test::limit_file_size(100);
    const std::string sentence = failure_of(ExitCode::io_error, [&directory] {
      HistoryWriter history(directory / "history.csv", columns);
      for (int i = 0; i < 100; ++i) append(history, i, 1.0, 0.0);
      history.finish();
    });
    return sentence.find("history.csv': File too large") != std::string::npos ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(std::filesystem::file_size(directory / "history.csv"), 100U);
}

}  // namespace
}  // namespace drogue::run
