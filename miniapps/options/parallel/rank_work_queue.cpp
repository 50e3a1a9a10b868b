#include "miniapps/options/desks.hpp"

#include <utility>

#include "common/program/signals.hpp"

namespace drogue::options_app {
namespace {

enum Tag { chunk_tag = 1, dismissal_tag, piece_tag };

constexpr int first_rank = 0;
constexpr std::size_t most_pieces = 4;  // that wait to be taken

}  // namespace

bool OwnDesk::next(Chunk& chunk) {
  _is_complete = !_source.next(chunk);
  return !_is_complete;
}

void OwnDesk::hand_in(Piece piece) {
  if (piece.leaves) {
    _spent = piece.spent;
    return;
  }
  _outputs.write(piece);
  _rows += piece.tally.rows;
  if (piece.ends_chunk) _source.learn(std::exchange(_rows, 0), piece.seconds);
  _progress.update_rows(_outputs.tally().rows, _source.share());
}

bool SharedDesk::next(Chunk& chunk) {
  std::unique_lock lock(_mutex);
  _changed.wait(lock, [this] { return _is_closed || !_chunks.empty(); });
  if (_is_closed) return false;
  chunk = std::move(_chunks.front());
  _chunks.pop_front();
  return true;
}

void SharedDesk::hand_in(Piece piece) {
  std::unique_lock lock(_mutex);
  _changed.wait(lock, [&] { return _is_closed || piece.leaves || _pieces.size() < most_pieces; });
  _pieces.push_back(std::move(piece));
}

bool SharedDesk::is_closed() {
  const std::lock_guard lock(_mutex);
  return _is_closed;
}

void SharedDesk::give(Chunk chunk) {
  const std::lock_guard lock(_mutex);
  _chunks.push_back(std::move(chunk));
  _changed.notify_all();
}

std::optional<Piece> SharedDesk::take() {
  const std::lock_guard lock(_mutex);
  if (_pieces.empty()) return std::nullopt;
  std::optional<Piece> piece(std::move(_pieces.front()));
  _pieces.pop_front();
  _changed.notify_all();
  return piece;
}

void SharedDesk::dismiss() {
  const std::lock_guard lock(_mutex);
  _is_closed = true;
  _changed.notify_all();
}

bool RankDesk::next(Chunk& chunk) {
  Backoff pause;
  while (!interrupted() && !is_closed()) {
    if (const auto message = _ranks.receive(first_rank, chunk_tag)) {
      chunk = chunk_from(*message);
      return true;
    }
    pause.wait();
  }
  return false;
}

void RankDesk::hand_in(Piece piece) {
  _ranks.send(first_rank, piece_tag, to_message(piece));
  _ranks.wait_until_sent();
  if (piece.leaves) await_dismissal();
}

/// Chunks may come until the first rank has heard that this one leaves; they have to be taken, or MPI waits
/// for it for ever.
void RankDesk::await_dismissal() {
  Backoff pause;
  bool is_dismissed = false;
  for (;;) {
    is_dismissed = is_dismissed || _ranks.receive(first_rank, dismissal_tag);
    const bool took = _ranks.receive(first_rank, chunk_tag).has_value();
    if (is_dismissed && !took && !_ranks.has_message(first_rank, chunk_tag)) return;
    pause.wait();
  }
}

bool RankDesk::is_closed() { return _ranks.has_message(first_rank, dismissal_tag); }

void RankHelper::give(Chunk chunk) { _ranks.send(_rank, chunk_tag, to_message(chunk)); }

std::optional<Piece> RankHelper::take() {
  const auto message = _ranks.receive(_rank, piece_tag);
  if (!message) return std::nullopt;
  return piece_from(*message);
}

void RankHelper::dismiss() { _ranks.send(_rank, dismissal_tag, ""); }

}  // namespace drogue::options_app
