#pragma once

#include <cstdint>

namespace drogue::run {

/// `count` blocks of `length` entries of a list: the first from entry `first` on, the others each `stride`
/// entries behind the one before.
struct Blocks {
  std::uint64_t first, length, count, stride;
};

/// Entries [first, first + length). Does not throw.
[[nodiscard]] constexpr Blocks one_block(std::uint64_t first, std::uint64_t length) {
  return {first, length, 1, length};
}

}  // namespace drogue::run
