#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include "common/program/communicator.hpp"
#include "common/program/progress.hpp"
#include "miniapps/options/chunk_source.hpp"
#include "miniapps/options/desk.hpp"
#include "miniapps/options/outputs.hpp"

namespace drogue::options_app {

/// The desk of a rank that is alone: reads and writes when it is asked to.
class OwnDesk final : public Desk {
 public:
  OwnDesk(ChunkSource& source, Outputs& outputs, ProgressLine& progress)
      : _source(source), _outputs(outputs), _progress(progress) {}

  bool next(Chunk& chunk) override;
  void hand_in(Piece piece) override;
  bool is_closed() override { return false; }

  /// Whether all rows are written.
  [[nodiscard]] bool is_complete() const { return _is_complete; }
  [[nodiscard]] const Spent& spent() const { return _spent; }

 private:
  ChunkSource& _source;
  Outputs& _outputs;
  ProgressLine& _progress;
  std::int64_t _rows = 0;  ///< of the chunk, so far
  bool _is_complete = false;
  Spent _spent;
};

/// Both sides of a desk between two threads.
class SharedDesk final : public Desk, public Helper {
 public:
  bool next(Chunk& chunk) override;
  void hand_in(Piece piece) override;
  bool is_closed() override;

  void give(Chunk chunk) override;
  std::optional<Piece> take() override;
  void dismiss() override;

 private:
  std::mutex _mutex;
  std::condition_variable _changed;
  std::deque<Chunk> _chunks;
  std::deque<Piece> _pieces;
  bool _is_closed = false;
};

/// The desk of every rank but the first.
class RankDesk final : public Desk {
 public:
  explicit RankDesk(Communicator& ranks) : _ranks(ranks) {}

  bool next(Chunk& chunk) override;
  void hand_in(Piece piece) override;
  bool is_closed() override;

 private:
  void await_dismissal();

  Communicator& _ranks;
};

/// Such a rank as the first one sees it.
class RankHelper final : public Helper {
 public:
  RankHelper(Communicator& ranks, int rank) : _ranks(ranks), _rank(rank) {}

  void give(Chunk chunk) override;
  std::optional<Piece> take() override;
  void dismiss() override;

 private:
  Communicator& _ranks;
  int _rank;
};

}  // namespace drogue::options_app
