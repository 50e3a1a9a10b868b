#include "miniapps/options/input/chunk.hpp"

#include "common/program/message.hpp"

namespace drogue::options_app {

std::string to_message(const Chunk& chunk) {
  MessageWriter message;
  message.put(chunk.number);
  message.put(chunk.first_row);
  message.put(chunk.contracts_per_call);
  message.put_all(chunk.lines);
  message.put_text(chunk.text);
  return message.take();
}

Chunk chunk_from(const std::string& message) {
  MessageReader reader(message);
  Chunk chunk;
  chunk.number = reader.get<std::int64_t>();
  chunk.first_row = reader.get<std::int64_t>();
  chunk.contracts_per_call = reader.get<std::size_t>();
  chunk.lines = reader.get_all<ChunkLine>();
  chunk.text = reader.get_text();
  return chunk;
}

}  // namespace drogue::options_app
