#include "miniapps/options/dispatcher.hpp"

#include <utility>

#include "common/program/communicator.hpp"
#include "common/program/signals.hpp"

namespace drogue::options_app {
namespace {

constexpr int chunks_a_helper = 2;  // one that is priced and one that waits

std::size_t size_of(const Piece& piece) { return piece.prices.size() + piece.boundaries.size(); }

}  // namespace

Dispatcher::Dispatcher(ChunkSource& source, Outputs& outputs, ProgressLine& progress,
                       std::vector<Helper*> helpers, std::size_t most_held)
    : _source(source),
      _outputs(outputs),
      _progress(progress),
      _helpers(std::move(helpers)),
      _most_held(most_held),
      _given(_helpers.size(), 0),
      _has_left(_helpers.size(), false) {}

bool Dispatcher::run() {
  try {
    const bool is_complete = hand_out();
    // Before others are waited for: a launcher that ends all of them does not wait long.
    if (!is_complete) _outputs.discard();
    dismiss();
    return is_complete;
  } catch (...) {
    dismiss();
    throw;
  }
}

bool Dispatcher::hand_out() {
  Backoff pause;
  while (!interrupted() && _helpers_left == 0) {
    const bool gave = give();
    const bool took = take();
    if (_is_read && _open.empty()) return true;
    if (gave || took) {
      pause.reset();
    } else {
      pause.wait();
    }
  }
  return false;
}

bool Dispatcher::give() {
  bool gave = false;
  for (std::size_t i = 0; i < _helpers.size(); ++i) {
    if (_is_read || _given[i] == chunks_a_helper) continue;
    Chunk chunk;
    if (!_source.next(chunk)) {
      _is_read = true;
      return gave;
    }
    _helpers[i]->give(std::move(chunk));
    ++_given[i];
    _open.push_back({i, {}});
    gave = true;
  }
  return gave;
}

bool Dispatcher::take() {
  bool took = false;
  for (std::size_t i = 0; i < _helpers.size(); ++i) {
    const bool has_first = !_open.empty() && _open.front().helper == i;
    if (!has_first && _held > _most_held) continue;
    if (std::optional<Piece> piece = _helpers[i]->take()) {
      accept(i, *std::move(piece));
      took = true;
    }
  }
  return took;
}

void Dispatcher::accept(std::size_t helper, Piece piece) {
  if (piece.leaves) return note_leaving(helper, piece);
  Open& open = _open[static_cast<std::size_t>(piece.chunk - _first)];
  open.rows += piece.tally.rows;
  open.is_ended = piece.ends_chunk;
  if (piece.ends_chunk) {
    --_given[helper];
    _source.learn(open.rows, piece.seconds);
  }
  _held += size_of(piece);
  open.pieces.push_back(std::move(piece));
  write_first();
}

/// Writes what stands in the order of the input from where the last row was written.
void Dispatcher::write_first() {
  while (!_open.empty()) {
    Open& open = _open.front();
    for (; !open.pieces.empty(); open.pieces.pop_front()) {
      _outputs.write(open.pieces.front());
      _held -= size_of(open.pieces.front());
    }
    if (!open.is_ended) break;
    _open.pop_front();
    ++_first;
  }
  _progress.update_rows(_outputs.tally().rows, _source.share());
}

void Dispatcher::note_leaving(std::size_t helper, const Piece& piece) {
  _has_left[helper] = true;
  ++_helpers_left;
  _spent.add(piece.spent);
}

void Dispatcher::dismiss() {
  for (Helper* helper : _helpers) helper->dismiss();
  Backoff pause;
  while (_helpers_left < _helpers.size()) {
    for (std::size_t i = 0; i < _helpers.size(); ++i) {
      // What is not written yet never will be.
      const std::optional<Piece> piece = _has_left[i] ? std::nullopt : _helpers[i]->take();
      if (piece && piece->leaves) note_leaving(i, *piece);
    }
    pause.wait();
  }
}

}  // namespace drogue::options_app
