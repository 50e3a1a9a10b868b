#include "common/run/restart/checksum.hpp"

#include <bit>
#include <cstdio>
#include <cstring>

namespace drogue::run {

void Checksum::add_word(std::uint64_t word) { _state = std::rotl((_state ^ word) * 0xff51afd7ed558ccdU, 29); }

void Checksum::add(std::span<const char> bytes) {
  _length += bytes.size();
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, 8);
    add_word(word);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, bytes.data() + i, bytes.size() - i);
  if (i < bytes.size()) add_word(rest);
}

std::uint64_t Checksum::value() const {
  Checksum last = *this;
  last.add_word(_length);
  return last._state ^ (last._state >> 32U);
}

std::string hexadecimal(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace drogue::run
