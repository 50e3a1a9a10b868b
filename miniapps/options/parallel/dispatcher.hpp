#pragma once

#include <deque>
#include <vector>

#include "common/program/progress.hpp"
#include "miniapps/options/chunk_source.hpp"
#include "miniapps/options/desk.hpp"
#include "miniapps/options/outputs.hpp"

namespace drogue::options_app {

/// Hands out the chunks of a batch and writes what comes back in the order of the input, in bounded memory:
/// each helper has two chunks, and while much waits to be written only the helper that has the next rows is
/// listened to.
class Dispatcher {
 public:
  /// `most_held`: bytes that may wait to be written, but for what one helper hands in at a time.
  Dispatcher(ChunkSource& source, Outputs& outputs, ProgressLine& progress, std::vector<Helper*> helpers,
             std::size_t most_held = std::size_t{64} << 20);

  /// Returns when all helpers have left: true if every row is written, false after a signal here or at a
  /// helper, or if a helper left that had a chunk. Throws Failure(io_error) after it let all of them go.
  bool run();

  /// Lets all helpers leave and waits until they have.
  void dismiss();

  /// What the helpers spent together, after run().
  [[nodiscard]] const Spent& spent() const { return _spent; }

 private:
  struct Open {
    std::size_t helper;
    std::deque<Piece> pieces;
    std::int64_t rows = 0;
    bool is_ended = false;
  };

  bool hand_out();
  bool give();
  bool take();
  void accept(std::size_t helper, Piece piece);
  void write_first();
  void note_leaving(std::size_t helper, const Piece& piece);

  ChunkSource& _source;
  Outputs& _outputs;
  ProgressLine& _progress;
  std::vector<Helper*> _helpers;
  std::size_t _most_held;
  std::vector<int> _given;      ///< chunks that each helper has
  std::vector<bool> _has_left;  ///< of each helper
  std::size_t _helpers_left = 0;
  std::deque<Open> _open;   ///< chunks that are not written, in order
  std::int64_t _first = 0;  ///< number of the first of them
  std::size_t _held = 0;    ///< bytes that wait to be written
  bool _is_read = false;
  Spent _spent;
};

}  // namespace drogue::options_app
