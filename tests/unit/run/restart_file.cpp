#include "common/run/restart/restart_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/run/files/atomic_file.hpp"
#include "tests/support/refusal.hpp"
#include "tests/unit/run/temporary_directory.hpp"

namespace drogue::run {
namespace {

using test::content;
using test::failure_of;
using test::TemporaryDirectory;

const std::string scene = fingerprint("cells = 500");

std::vector<double> state(std::size_t size = 1500) {
  std::vector<double> values(size);
  std::iota(values.begin(), values.end(), 0.1);
  return values;
}

void write_restart(const std::filesystem::path& file, double time, std::size_t size = 1500) {
  const std::vector<double> values = state(size);
  RestartWriter restart(file, scene);
  restart.number("time", time);
  restart.integer("step", 1'234'567'890'123);
  restart.array("U", size);
  restart.write("U", size / 2, std::span(values).subspan(size / 2));
  restart.write("U", 0, std::span(values).first(size / 2));
  restart.commit();
}

std::string refusal(const std::filesystem::path& file) {
  return failure_of(ExitCode::io_error, [&file] { const RestartReader restart(file, scene); });
}

TEST(RestartFile, RestoresEveryBit) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0 / 3.0);
  const RestartReader restart(directory / "restart.h5", scene);
  EXPECT_EQ(restart.number("time"), 1.0 / 3.0);
  EXPECT_EQ(restart.integer("step"), 1'234'567'890'123);
  std::vector<double> values(1500);
  restart.read("U", 0, std::span(values).first(700));
  restart.read("U", 700, std::span(values).subspan(700));
  EXPECT_EQ(values, state());
}

TEST(RestartFile, WritesAndReadsBlocks) {
  const TemporaryDirectory directory;
  const Blocks even{0, 2, 3, 4}, odd{2, 2, 3, 4};
  const std::vector<double> first = {0, 1, 4, 5, 8, 9}, second = {2, 3, 6, 7, 10, 11};
  RestartWriter writer(directory / "restart.h5", scene);
  writer.array("U", 12);
  writer.write("U", odd, second);
  writer.write("U", even, first);
  EXPECT_NE(testing::refusal_of(
                [&] {
                  writer.write("U", Blocks{4, 2, 3, 4}, first);
                },
                ExitCode::io_error),
            "");
  writer.commit();
  const RestartReader reader(directory / "restart.h5", scene);
  std::vector<double> whole(12), ascending(12), part(6);
  std::iota(ascending.begin(), ascending.end(), 0.0);
  reader.read("U", 0, whole);
  reader.read("U", odd, part);
  EXPECT_EQ(whole, ascending);
  EXPECT_EQ(part, second);
}

TEST(RestartFile, NamesAMissingEntry) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0);
  const RestartReader restart(directory / "restart.h5", scene);
  const std::string number =
      failure_of(ExitCode::io_error, [&restart] { static_cast<void>(restart.number("dt")); });
  EXPECT_NE(number.find("'dt'"), std::string::npos) << number;
  std::vector<double> values(1);
  const std::string array = failure_of(ExitCode::io_error, [&] { restart.read("V", 0, values); });
  EXPECT_NE(array.find("restart.h5"), std::string::npos) << array;
}

TEST(RestartFile, KeepsTheFormerFileUntilCommit) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0);
  {
    RestartWriter unfinished(directory / "restart.h5", scene);
    unfinished.number("time", 2.0);
  }
  EXPECT_EQ(directory.entries(), 1U) << "the temporary file was left";
  const int status = test::in_child([&directory] {
    RestartWriter killed(directory / "restart.h5", scene);
    killed.number("time", 2.0);
    return raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(RestartReader(directory / "restart.h5", scene).number("time"), 1.0);
}

TEST(RestartFile, KeepsTheFormerFileOnAFullDisk) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0);
  const int status = test::in_child([&directory] {
    test::limit_file_size(100'000);
    const std::string sentence = failure_of(
        ExitCode::io_error, [&directory] { write_restart(directory / "restart.h5", 2.0, 50'000); });
    return sentence.find("File too large") != std::string::npos ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(directory.entries(), 1U) << "the temporary file was left";
  EXPECT_EQ(RestartReader(directory / "restart.h5", scene).number("time"), 1.0);
}

TEST(RestartFile, RefusesATruncatedFile) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0);
  const std::string whole = content(directory / "restart.h5");
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{30}, std::size_t{600}, whole.size() - 1}) {
    write_file_atomically(directory / "restart.h5", whole.substr(0, bytes));
    const std::string sentence = refusal(directory / "restart.h5");
    const std::string reason = bytes == 0 ? "it is not a restart file of Drogue" : "it is truncated";
    EXPECT_EQ(sentence,
              "cannot continue from restart file '" + (directory / "restart.h5").string() + "': " + reason);
  }
}

TEST(RestartFile, RefusesAnyChangedByte) {
  const TemporaryDirectory directory;
  write_restart(directory / "restart.h5", 1.0);
  const std::string whole = content(directory / "restart.h5");
  for (std::size_t position = 512; position < whole.size(); position += 97) {
    std::string damaged = whole;
    damaged[position] = static_cast<char>(damaged[position] ^ 0x10);
    write_file_atomically(directory / "restart.h5", damaged);
    EXPECT_NE(refusal(directory / "restart.h5").find("it is damaged"), std::string::npos) << position;
  }
}

TEST(RestartFile, RefusesForeignFilesAndScenes) {
  const TemporaryDirectory directory;
  EXPECT_NE(refusal(directory / "none.h5").find("No such file"), std::string::npos);
  EXPECT_NE(refusal(directory.path()).find("not a restart file"), std::string::npos)
      << refusal(directory.path());
  write_file_atomically(directory / "text.h5", std::string(2000, 'x'));
  EXPECT_NE(refusal(directory / "text.h5").find("not a restart file"), std::string::npos);

  write_restart(directory / "restart.h5", 1.0);
  std::string newer = content(directory / "restart.h5");
  newer.replace(newer.find("drogue.restart/1"), 16, "drogue.restart/2");
  write_file_atomically(directory / "newer.h5", newer);
  EXPECT_NE(refusal(directory / "newer.h5").find("its format is drogue.restart/2"), std::string::npos);

  const std::string other = failure_of(ExitCode::io_error, [&directory] {
    const RestartReader restart(directory / "restart.h5", fingerprint("cells = 501"));
  });
  EXPECT_NE(other.find("another scene"), std::string::npos) << other;
}

TEST(Fingerprint, DistinguishesTextsOfEveryLength) {
  EXPECT_EQ(fingerprint("cells = 500"), scene);
  std::string text;
  std::vector<std::string> seen;
  for (int i = 0; i < 40; ++i, text += '\0') seen.push_back(fingerprint(text));
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

}  // namespace
}  // namespace drogue::run
