#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace drogue::run {

/// 64-bit checksum of a byte stream. Each step is a bijection of the state, so a change within one aligned
/// 8-byte word is always detected; other changes are missed with probability 2^-64. Not cryptographic.
class Checksum {
 public:
  /// Adds bytes. The length of every piece but the last must be a multiple of 8.
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
