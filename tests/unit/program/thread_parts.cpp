#include "common/program/thread_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace drogue {
namespace {

TEST(ThreadParts, AreOneWithoutEnoughEntries) {
  EXPECT_EQ(thread_parts(0, 10), 1U);
  EXPECT_EQ(thread_parts(9, 10), 1U);
}

TEST(ThreadParts, AreNoMoreThanCores) {
  EXPECT_EQ(thread_parts(1'000'000'000, 1), std::max(1U, std::thread::hardware_concurrency()));
}

TEST(ThreadParts, CoverEveryEntryOnce) {
  for (const std::size_t parts : {1U, 2U, 3U, 7U}) {
    std::vector<int> visits(100, 0);
    std::vector<int> calls(parts, 0);
    for_thread_parts(parts, visits.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
      ++calls[part];
      for (std::size_t entry = begin; entry < end; ++entry) ++visits[entry];
    });
    EXPECT_EQ(visits, std::vector<int>(100, 1)) << parts;
    EXPECT_EQ(calls, std::vector<int>(parts, 1)) << parts;
  }
}

TEST(ThreadParts, WorkInThreadsOfTheirOwn) {
  std::vector<std::thread::id> ids(3);
  for_thread_parts(
      3, 3, [&](std::size_t part, std::size_t, std::size_t) { ids[part] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], std::this_thread::get_id());
  EXPECT_NE(ids[1], ids[0]);
  EXPECT_NE(ids[2], ids[0]);
}

TEST(ThreadParts, ThrowWhatTheFirstFailedPartThrewAfterAllHaveEnded) {
  for (const std::size_t first : {0U, 1U, 2U}) {
    std::vector<int> ended(4, 0);
    try {
      for_thread_parts(4, 4, [&](std::size_t part, std::size_t, std::size_t) {
        ended[part] = 1;
        if (part >= first) throw std::runtime_error(std::to_string(part));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::to_string(first));
    }
    EXPECT_EQ(ended, std::vector<int>(4, 1)) << first;
  }
}

}  // namespace
}  // namespace drogue
