#include "common/run/background_writer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <vector>

namespace drogue::run {
namespace {

TEST(BackgroundWriter, RunsTasksInOrderOnAnotherThread) {
  std::vector<int> order;
  std::thread::id worker;
  BackgroundWriter writer;
  for (int i = 0; i < 100; ++i) {
    writer.submit([&order, &worker, i] {
      order.push_back(i);
      worker = std::this_thread::get_id();
    });
  }
  writer.finish();
  ASSERT_EQ(order.size(), 100U);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  EXPECT_NE(worker, std::this_thread::get_id());
}

TEST(BackgroundWriter, SubmitReturnsWhileATaskRuns) {
  std::promise<void> release;
  std::atomic<int> done = 0;
  BackgroundWriter writer(2);
  writer.submit([&release, &done] {
    release.get_future().wait();
    ++done;
  });
  writer.submit([&done] { ++done; });  // would never return if it waited for the first task
  EXPECT_EQ(done, 0);
  release.set_value();
  writer.finish();
  EXPECT_EQ(done, 2);
}

TEST(BackgroundWriter, RunsAtMostDepthTasks) {
  std::promise<void> release;
  BackgroundWriter writer(1);
  writer.submit([&release] { release.get_future().wait(); });
  auto second = std::async(std::launch::async, [&writer] { writer.submit([] {}); });
  EXPECT_EQ(second.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  release.set_value();
  second.get();
  writer.finish();
}

TEST(BackgroundWriter, RethrowsAFailureOnce) {
  BackgroundWriter writer;
  writer.submit([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(writer.finish(), std::runtime_error);
  bool written = false;
  writer.submit([&written] { written = true; });
  EXPECT_NO_THROW(writer.finish());
  EXPECT_TRUE(written);
}

TEST(BackgroundWriter, SubmitRethrowsAnEarlierFailure) {
  BackgroundWriter writer(1);
  writer.submit([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(
      {
        writer.submit([] {});  // depth 1: the failed task is over when a place is free
        writer.finish();
      },
      std::runtime_error);
}

TEST(BackgroundWriter, DestructorFinishesSubmittedTasks) {
  int written = 0;
  {
    BackgroundWriter writer;
    writer.submit([&written] { ++written; });
    writer.submit([&written] { ++written; });
  }
  EXPECT_EQ(written, 2);
}

}  // namespace
}  // namespace drogue::run
