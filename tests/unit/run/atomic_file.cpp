#include "common/run/files/atomic_file.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

TEST(RequireWritable, LeavesNothingBehind) {
  const TemporaryDirectory directory;
  require_writable("");
  require_writable("/dev/null");
  require_writable(directory / "a.txt");
  EXPECT_EQ(directory.entries(), 0U);
  write_file_atomically(directory / "a.txt", "former");
  require_writable(directory / "a.txt");
  EXPECT_EQ(content(directory / "a.txt"), "former");
}

TEST(RequireWritable, RejectsUnwritableTargets) {
  const TemporaryDirectory directory;
  for (const std::filesystem::path& path : {directory / "missing/a.txt", directory.path()}) {
    const std::string sentence = failure_of(ExitCode::io_error, [&path] { require_writable(path); });
    EXPECT_NE(sentence.find(path.string()), std::string::npos) << sentence;
  }
  const std::string sentence = failure_of(ExitCode::usage, [] { require_writable("-"); });
  EXPECT_NE(sentence.find("/dev/stdout"), std::string::npos) << sentence;
}

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

TEST(AtomicFile, AbandonedWriteKeepsTheFormerFile) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", "old");
  {
    AtomicFile file(directory / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(content(directory / "a.txt"), "old");
  EXPECT_EQ(directory.entries(), 1U);
}

// ctest-label: no-sanitizer
TEST(AtomicFile, KilledWriterKeepsTheFormerFile) {
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

TEST(AtomicFile, ThrowsOnFullDiskAndKeepsTheFormerFile) {
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

TEST(AtomicFile, NamesFileAndCauseForAnUnwritableFolder) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "file", "");
  const std::string below_a_file = failure_of(
      ExitCode::io_error, [&directory] { write_file_atomically(directory / "file/result.json", "x"); });
  EXPECT_NE(below_a_file.find("file/result.json': Not a directory"), std::string::npos) << below_a_file;
}

TEST(AtomicFile, KeepsADirectoryOfThatName) {
  const TemporaryDirectory directory;
  std::filesystem::create_directories(directory / "result.json/full");
  const std::string sentence =
      failure_of(ExitCode::io_error, [&directory] { write_file_atomically(directory / "result.json", "x"); });
  EXPECT_NE(sentence.find("directory"), std::string::npos) << sentence;
  EXPECT_EQ(directory.entries(), 1U) << "the temporary file was left";
}

TEST(AtomicFile, ThrowsOnAFullDevice) {
  EXPECT_EQ(failure_of(ExitCode::io_error, [] { write_file_atomically("/dev/full", "x"); }),
            "cannot write '/dev/full': No space left on device");
  write_file_atomically("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, WritesEveryByteToANamedPipe) {
  const TemporaryDirectory directory;
  const std::string pipe = directory / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_file_atomically(pipe, "rows");
  std::string got(16, '\0');
  got.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(reader, got.data(), got.size()))));
  close(reader);
  EXPECT_EQ(got, "rows");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(directory.entries(), 1U);
}

/// Path like /dev/stdout: neither the link nor earlier output may be replaced.
TEST(AtomicFile, AppendsToAnOpenDescriptor) {
  const TemporaryDirectory directory;
  const std::string file = directory / "a.txt";
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(write(descriptor, "top ", 4), 4);
  std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(descriptor), directory / "out");
  write_file_atomically(directory / "out", "rows");
  close(descriptor);
  EXPECT_EQ(content(file), "top rows");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "out"));
  EXPECT_EQ(directory.entries(), 2U);
  failure_of(ExitCode::io_error, [&directory] { write_file_atomically(directory / "out", "x"); });
}

}  // namespace
}  // namespace drogue::run
