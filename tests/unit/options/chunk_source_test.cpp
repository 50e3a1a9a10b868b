#include "miniapps/options/input/chunk_source.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace drogue::options_app {
namespace {

/// 100 equal parameter sets.
class OptionsChunkSource : public ::testing::Test {
 protected:
  void SetUp() override {
    _file = ::testing::TempDir() + "drogue_chunks_" + std::to_string(::getpid()) + ".csv";
    std::ofstream file(_file);
    file << "spot,rate,lambda,alpha,beta,delta\n";
    for (int row = 0; row < 100; ++row) file << "1,0,1,9,-2,1\n";
    _command.action = Action::surface;
    _command.strikes = {1.0, 2.0, 3.0, 4.0};
    _command.maturities = {1.0, 2.0};
  }
  void TearDown() override { std::filesystem::remove(_file); }

  std::filesystem::path _file;
  Command _command;
};

TEST_F(OptionsChunkSource, ShareIsThatOfTheRowsWritten) {
  _command.chunk = 80;
  BatchReader reader(_file, RowKind::parameter_set);
  ChunkSource source(_command, reader, 1);
  RowCounts written;
  EXPECT_EQ(source.share(written), 0.0);
  for (Chunk chunk; source.next(chunk); written.rows += 80)
    EXPECT_NEAR(source.share(written), static_cast<double>(written.rows) / 800.0, 0.03);
  EXPECT_EQ(written.rows, 800);
  EXPECT_EQ(source.share(written), 1.0);
}

TEST_F(OptionsChunkSource, ShareOfOneChunkCountsItsPoints) {
  _command.chunk = 1000;
  BatchReader reader(_file, RowKind::parameter_set);
  ChunkSource source(_command, reader, 1);
  Chunk chunk;
  ASSERT_TRUE(source.next(chunk));
  RowCounts written;
  written.rows = 200;
  EXPECT_DOUBLE_EQ(source.share(written), 0.25);
  // 20 invalid rows are parameter sets, which have no other row; 3 are points of valid sets.
  written.rows = 420, written.invalid = 23, written.invalid_points = 3;
  EXPECT_DOUBLE_EQ(source.share(written), 0.7);
}

}  // namespace
}  // namespace drogue::options_app
