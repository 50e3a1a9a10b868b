#include "common/run/atomic_file.hpp"

#include <gtest/gtest.h>

#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryDirectory directory;
  AtomicFile file(directory / "a.txt");
  file.write("one ");
  file.write("two");
  EXPECT_FALSE(std::filesystem::exists(directory / "a.txt"));
  file.commit();
  EXPECT_EQ(content(directory / "a.txt"), "one two");
  EXPECT_EQ(directory.entries(), 1U);
}

TEST(AtomicFile, AbandonedLeavesTheFormerFile) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", "old");
  {
    AtomicFile file(directory / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(content(directory / "a.txt"), "old");
  EXPECT_EQ(directory.entries(), 1U);
}

TEST(AtomicFile, KilledWriterLeavesTheFormerFile) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", "old");
  const int status = test::in_child([&directory] {
    AtomicFile file(directory / "a.txt");
    file.write("new");
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(content(directory / "a.txt"), "old");
}

TEST(AtomicFile, FullDiskIsAFailureThatLeavesTheFormerFile) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", "old");
  const int status = test::in_child([&directory] {
    test::limit_file_size(1000);
    const std::string sentence = failure_of(ExitCode::io_error, [&directory] {
      write_file_atomically(directory / "a.txt", std::string(5000, 'x'));
    });
    const std::string wanted = "cannot write '" + (directory / "a.txt").string() + "': File too large";
    return sentence == wanted ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(content(directory / "a.txt"), "old");
  EXPECT_EQ(directory.entries(), 1U);
}

TEST(AtomicFile, UnwritablePlaceNamesFileAndCause) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "file", "");
  const std::string below_a_file = failure_of(
      ExitCode::io_error, [&directory] { write_file_atomically(directory / "file/result.json", "x"); });
  EXPECT_NE(below_a_file.find("file/result.json': Not a directory"), std::string::npos) << below_a_file;
}

TEST(AtomicFile, ADirectoryInTheWayStays) {
  const TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "result.json/full");
  const std::string sentence =
      failure_of(ExitCode::io_error, [&directory] { write_file_atomically(directory / "result.json", "x"); });
  EXPECT_NE(sentence.find("directory"), std::string::npos) << sentence;
  EXPECT_EQ(directory.entries(), 1U) << "the temporary file was left";
}

}  // namespace
}  // namespace drogue::run
