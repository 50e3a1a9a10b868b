#include "miniapps/options/chunk.hpp"

#include <algorithm>

#include "common/program/message.hpp"

namespace drogue::options_app {

void Tally::add(const Tally& later) {
  if (invalid == 0) {
    invalid_line = later.invalid_line;
    invalid_fault = later.invalid_fault;
  }
  if (failed == 0) failed_line = later.failed_line;
  rows += later.rows;
  coarse += later.coarse;
  invalid += later.invalid;
  failed += later.failed;
  invalid_points += later.invalid_points;
}

void Spent::add(const Spent& other) {
  timing.h2d += other.timing.h2d;
  timing.compute += other.timing.compute;
  timing.d2h += other.timing.d2h;
  pricing += other.pricing;
  ledger.kernel_launches += other.ledger.kernel_launches;
  ledger.fences += other.ledger.fences;
  ledger.allocations_after_warmup += other.ledger.allocations_after_warmup;
  ledger.h2d_bytes += other.ledger.h2d_bytes;
  ledger.d2h_bytes += other.ledger.d2h_bytes;
  ledger.peak_device_bytes = std::max(ledger.peak_device_bytes, other.ledger.peak_device_bytes);
}

std::string to_message(const Chunk& chunk) {
  MessageWriter message;
  message.put(chunk.number);
  message.put(chunk.first_row);
  message.put(chunk.together);
  message.put_all(chunk.lines);
  message.put_text(chunk.text);
  return message.take();
}

Chunk chunk_from(const std::string& message) {
  MessageReader reader(message);
  Chunk chunk;
  chunk.number = reader.get<std::int64_t>();
  chunk.first_row = reader.get<std::int64_t>();
  chunk.together = reader.get<std::size_t>();
  chunk.lines = reader.get_all<ChunkLine>();
  chunk.text = reader.get_text();
  return chunk;
}

std::string to_message(const Piece& piece) {
  MessageWriter message;
  message.put(piece.chunk);
  message.put(piece.ends_chunk);
  message.put(piece.seconds);
  const Tally& tally = piece.tally;
  for (const std::int64_t count : {tally.rows, tally.coarse, tally.invalid, tally.failed,
                                   tally.invalid_points, tally.invalid_line, tally.failed_line})
    message.put(count);
  message.put_text(tally.invalid_fault);
  message.put_text(piece.prices);
  message.put_text(piece.boundaries);
  message.put(piece.leaves);
  message.put(piece.spent);
  return message.take();
}

Piece piece_from(const std::string& message) {
  MessageReader reader(message);
  Piece piece;
  piece.chunk = reader.get<std::int64_t>();
  piece.ends_chunk = reader.get<bool>();
  piece.seconds = reader.get<double>();
  Tally& tally = piece.tally;
  for (std::int64_t* count : {&tally.rows, &tally.coarse, &tally.invalid, &tally.failed,
                              &tally.invalid_points, &tally.invalid_line, &tally.failed_line})
    *count = reader.get<std::int64_t>();
  tally.invalid_fault = reader.get_text();
  piece.prices = reader.get_text();
  piece.boundaries = reader.get_text();
  piece.leaves = reader.get<bool>();
  piece.spent = reader.get<Spent>();
  return piece;
}

}  // namespace drogue::options_app
