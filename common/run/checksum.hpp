#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace drogue::run {

/// Running 64-bit checksum of a stream of bytes. Each step is a bijection of its state, so any change
/// confined to one aligned 8-byte word is detected for certain, others up to 2^-64. No protection against
/// intent.
class Checksum {
 public:
  /// Every piece but the last must be a multiple of 8 bytes long.
  void add(std::span<const char> bytes);
  [[nodiscard]] std::uint64_t value() const;

 private:
  void add_word(std::uint64_t word);

  std::uint64_t _state = 0x9e3779b97f4a7c15U;
  std::uint64_t _length = 0;
};

/// 16 hexadecimal digits.
std::string hexadecimal(std::uint64_t value);

}  // namespace drogue::run
