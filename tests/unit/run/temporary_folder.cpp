#include "common/run/files/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/program/failure.hpp"

namespace drogue::run {
namespace {

TEST(TemporaryFolder, IsRemovedWithItsFiles) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder("drogue-test"), other("drogue-test");
    path = folder.path();
    EXPECT_NE(path, other.path());
    std::ofstream(path / "file") << "text";
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFolder, ReportsAFolderThatCannotBeMade) {
  EXPECT_THROW(TemporaryFolder("no-such-folder/drogue-test"), Failure);
}

}  // namespace
}  // namespace drogue::run
