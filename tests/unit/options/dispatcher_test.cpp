#include "miniapps/options/parallel/dispatcher.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace drogue::options_app {
namespace {

/// Returns one batch of results per line of its chunks, at every `delay`-th call of `receive`.
class FakeWorker final : public WorkerProxy {
 public:
  /// Appends `index` to `calls` at every call of `receive`.
  FakeWorker(std::vector<int>& calls, int index, int delay) : _calls(calls), _index(index), _delay(delay) {}

  void assign(Chunk chunk) override { _chunks.push_back(std::move(chunk)); }
  void shutdown() override { _is_shut_down = true; }

  std::optional<ResultBatch> receive() override {
    _calls.push_back(_index);
    ResultBatch batch;
    if (_is_shut_down || (_finishes_early && _line == 2)) {
      batch.worker_finished = true;
      batch.usage.wall_times.compute = 1.0;
      return batch;
    }
    if (_chunks.empty() || ++_polls % _delay != 0) return std::nullopt;
    const Chunk& chunk = _chunks.front();
    batch.chunk = chunk.number;
    batch.counts.rows = 1;
    batch.prices = std::to_string(chunk.first_row + _line) + std::string(_extra_bytes, ' ') + "\n";
    batch.ends_chunk = ++_line == static_cast<std::int64_t>(chunk.lines.size());
    if (batch.ends_chunk) {
      _line = 0;
      _chunks.pop_front();
    }
    return batch;
  }

  void finish_early() { _finishes_early = true; }
  void lengthen_rows(std::size_t bytes) { _extra_bytes = bytes; }

 private:
  std::vector<int>& _calls;
  int _index, _delay, _polls = 0;
  std::deque<Chunk> _chunks;
  std::int64_t _line = 0;
  std::size_t _extra_bytes = 0;
  bool _is_shut_down = false, _finishes_early = false;
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

  bool run(std::vector<WorkerProxy*> workers) {
    BatchReader reader(_folder / "batch.csv", RowKind::contract);
    ChunkSource source(_command, reader, 3);
    OutputFiles outputs(_command);
    ProgressLine progress(true);
    Dispatcher dispatcher(source, outputs, progress, workers, 350);
    const bool is_complete = dispatcher.run();
    EXPECT_EQ(dispatcher.usage().wall_times.compute, static_cast<double>(workers.size()));
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
  std::vector<int> _calls;
};

TEST_F(OptionsDispatcher, WritesInInputOrder) {
  std::vector<int> expected(30);
  for (int row = 0; row < 30; ++row) expected[static_cast<std::size_t>(row)] = row + 1;
  for (const int delay : {1, 2, 7, 40}) {
    FakeWorker a(_calls, 0, delay), b(_calls, 1, 1), c(_calls, 2, 3);
    EXPECT_TRUE(run({&a, &b, &c}));
    EXPECT_EQ(rows_written(), expected) << delay;
    std::filesystem::remove(_command.out);
  }
}

TEST_F(OptionsDispatcher, RemovesOutputsIfWorkerFinishesEarly) {
  FakeWorker a(_calls, 0, 1), b(_calls, 1, 2);
  b.finish_early();
  EXPECT_FALSE(run({&a, &b}));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(_folder)) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1U);
}

/// The first worker is slow. The results of the other must not accumulate without bound.
TEST_F(OptionsDispatcher, PollsOnlyWorkerWithNextRowsAtMemoryLimit) {
  constexpr int delay = 50;
  FakeWorker a(_calls, 0, delay), b(_calls, 1, 1);
  b.lengthen_rows(100);
  EXPECT_TRUE(run({&a, &b}));
  const auto first_row = static_cast<std::ptrdiff_t>(
      std::find_if(_calls.begin(), _calls.end(),
                   [count = 0](int worker) mutable { return worker == 0 && ++count == delay; }) -
      _calls.begin());
  EXPECT_EQ(std::count(_calls.begin(), _calls.begin() + first_row, 1), 4);
}

}  // namespace
}  // namespace drogue::options_app
