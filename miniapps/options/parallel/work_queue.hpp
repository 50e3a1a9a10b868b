#pragma once

#include <optional>

#include "miniapps/options/chunk.hpp"

namespace drogue::options_app {

/// Where a rank gets its chunks and hands in what became of them.
class Desk {
 public:
  virtual ~Desk() = default;

  /// The next chunk, as soon as there is one; false if no more are to be priced.
  virtual bool next(Chunk& chunk) = 0;

  /// Hands in the next part of the chunk that came last. May wait until there is room for it.
  virtual void hand_in(Piece piece) = 0;

  /// Whether the rest of the chunk is not wanted any more.
  [[nodiscard]] virtual bool is_closed() = 0;
};

/// A rank as the one that distributes sees it. Nothing waits.
class Helper {
 public:
  virtual ~Helper() = default;

  virtual void give(Chunk chunk) = 0;

  /// The next piece that it handed in, if there is one.
  virtual std::optional<Piece> take() = 0;

  /// Lets it leave, at once, even if it has a chunk. Its last piece says that it leaves.
  virtual void dismiss() = 0;
};

}  // namespace drogue::options_app
