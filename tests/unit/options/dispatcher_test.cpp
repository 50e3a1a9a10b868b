#include "miniapps/options/dispatcher.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace drogue::options_app {
namespace {

/// Answers to chunks with their lines, a piece a line, as late as the test wants.
class SlowHelper final : public Helper {
 public:
  SlowHelper(std::vector<int>& asked, int own, int patience)
      : _asked(asked), _own(own), _patience(patience) {}

  void give(Chunk chunk) override { _chunks.push_back(std::move(chunk)); }
  void dismiss() override { _is_dismissed = true; }

  std::optional<Piece> take() override {
    _asked.push_back(_own);
    Piece piece;
    if (_is_dismissed || (_leaves_early && _line == 2)) {
      piece.leaves = true;
      piece.spent.pricing = 1.0;
      return piece;
    }
    if (_chunks.empty() || ++_waited % _patience != 0) return std::nullopt;
    const Chunk& chunk = _chunks.front();
    piece.chunk = chunk.number;
    piece.tally.rows = 1;
    piece.prices = std::to_string(chunk.first_row + _line) + std::string(_bytes_more, ' ') + "\n";
    piece.ends_chunk = ++_line == static_cast<std::int64_t>(chunk.lines.size());
    if (piece.ends_chunk) {
      _line = 0;
      _chunks.pop_front();
    }
    return piece;
  }

  void leave_early() { _leaves_early = true; }
  void be_verbose(std::size_t bytes) { _bytes_more = bytes; }

 private:
  std::vector<int>& _asked;
  int _own, _patience, _waited = 0;
  std::deque<Chunk> _chunks;
  std::int64_t _line = 0;
  std::size_t _bytes_more = 0;
  bool _is_dismissed = false, _leaves_early = false;
};

class OptionsDispatcher : public ::testing::Test {
 protected:
  void SetUp() override {
    _folder = ::testing::TempDir() + "drogue_dispatcher_" + std::to_string(::getpid());
    std::filesystem::create_directory(_folder);
    std::ofstream file(_folder / "batch.csv");
    file << "spot,strike,rate,maturity,lambda,alpha,beta,delta\n";
    for (int row = 0; row < 30; ++row) file << "1,1,0,1,1,9,-2,1\n";
    _command.action = Action::price;
    _command.out = _folder / "prices.csv";
    _command.chunk = 3;
    _command.quiet = true;
  }
  void TearDown() override { std::filesystem::remove_all(_folder); }

  bool run(std::vector<Helper*> helpers) {
    BatchReader reader(_folder / "batch.csv", RowKind::contract);
    ChunkSource source(_command, reader, 3);
    Outputs outputs(_command);
    ProgressLine progress(true);
    Dispatcher dispatcher(source, outputs, progress, helpers, 350);
    const bool is_complete = dispatcher.run();
    EXPECT_EQ(dispatcher.spent().pricing, static_cast<double>(helpers.size()));
    if (is_complete) outputs.commit();
    return is_complete;
  }

  [[nodiscard]] std::vector<int> rows_written() const {
    std::ifstream file(_command.out);
    std::string line;
    std::getline(file, line);
    std::vector<int> rows;
    while (std::getline(file, line)) rows.push_back(std::stoi(line));
    return rows;
  }

  std::filesystem::path _folder;
  Command _command;
  std::vector<int> _asked;
};

TEST_F(OptionsDispatcher, WritesInTheOrderOfTheInput) {
  std::vector<int> expected(30);
  for (int row = 0; row < 30; ++row) expected[static_cast<std::size_t>(row)] = row + 1;
  for (const int patience : {1, 2, 7, 40}) {
    SlowHelper a(_asked, 0, patience), b(_asked, 1, 1), c(_asked, 2, 3);
    EXPECT_TRUE(run({&a, &b, &c}));
    EXPECT_EQ(rows_written(), expected) << patience;
    std::filesystem::remove(_command.out);
  }
}

TEST_F(OptionsDispatcher, LeavesNothingWhereAHelperLeavesEarly) {
  SlowHelper a(_asked, 0, 1), b(_asked, 1, 2);
  b.leave_early();
  EXPECT_FALSE(run({&a, &b}));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(_folder)) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1U);
}

/// The first helper is slow. What the others have done must not pile up while its rows are missing.
TEST_F(OptionsDispatcher, HearsOnlyTheNextOneWhileMuchWaits) {
  constexpr int patience = 50;
  SlowHelper a(_asked, 0, patience), b(_asked, 1, 1);
  b.be_verbose(100);
  EXPECT_TRUE(run({&a, &b}));
  const auto first_row = static_cast<std::ptrdiff_t>(
      std::find_if(_asked.begin(), _asked.end(),
                   [count = 0](int helper) mutable { return helper == 0 && ++count == patience; }) -
      _asked.begin());
  EXPECT_EQ(std::count(_asked.begin(), _asked.begin() + first_row, 1), 4);
}

}  // namespace
}  // namespace drogue::options_app
