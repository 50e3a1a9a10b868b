#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/device_communicator.hpp"
#include "tests/support/ranks.hpp"

// Messages from and to memory of an execution space, by each transport that the ranks can use.

namespace drogue::linear {
namespace {

using ExecutionSpace = DROGUE_TEST_SPACE;
using Communicator = DeviceCommunicator<ExecutionSpace>;
using List = Kokkos::View<double*, ExecutionSpace::memory_space>;
using testing::belongs_to_first;
using testing::first_ranks;

constexpr const char* variable = "DROGUE_TRANSPORT";

List list_of(const std::vector<double>& values) {
  const ExecutionSpace space;
  const List list("test", values.size());
  device::copy_in(space, list, values.data(), values.size());
  space.fence();
  return list;
}

std::vector<double> values_of(const List& list) {
  const ExecutionSpace space;
  std::vector<double> values(list.size());
  device::copy_out(space, values.data(), list, values.size());
  space.fence();
  return values;
}

class DeviceCommunicatorRanks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (RankGroup::world().size() != 4) GTEST_SKIP() << "needs mpirun with four ranks";
  }
  void TearDown() override { unsetenv(variable); }

  /// Calls `check(communicator)` on the first 1 to 4 ranks with each transport that they can use.
  template <class Check>
  void for_each_communicator(const Check& check) {
    const ExecutionSpace space;
    for (const int ranks : {1, 2, 3, 4}) {
      const RankGroup group = first_ranks(ranks);
      if (!belongs_to_first(ranks)) continue;
      int usable = 0;
      for (const std::string_view transport : transport_names) {
        setenv(variable, std::string(transport).c_str(), 1);
        try {
          const Communicator communicator(space, group);
          EXPECT_EQ(ranks == 1 ? "none" : transport, name(communicator.transport()));
          check(communicator);
          ++usable;
        } catch (const std::invalid_argument&) {
          EXPECT_GT(ranks, 1);
        }
        if (ranks == 1) break;
      }
      EXPECT_GE(usable, ranks > 1 && device::is_host<ExecutionSpace> ? 2 : 1);
    }
  }
};

TEST_F(DeviceCommunicatorRanks, ExchangesBetweenNeighboursByTags) {
  for_each_communicator([](const Communicator& communicator) {
    const ExecutionSpace space;
    const int rank = communicator.rank(), size = communicator.size();
    if (size == 1) return;
    // On two ranks both neighbours are the same rank, and only tags tell the messages apart.
    const int low = (rank + size - 1) % size, high = (rank + 1) % size;
    const auto to_high = [](int from) {
      return std::vector<double>(static_cast<std::size_t>(5 + from), from + 0.25);
    };
    const auto to_low = [](int from) {
      return std::vector<double>(static_cast<std::size_t>(9 - from), from + 0.5);
    };
    const List up = list_of(to_high(rank)), down = list_of(to_low(rank)),
               from_low = list_of(std::vector<double>(to_high(low).size(), -1.0)),
               from_high = list_of(std::vector<double>(to_low(high).size(), -1.0));
    enum Tag { upwards, downwards };
    const std::vector<Message> messages = {
        {low, downwards, upwards, {down.data(), down.size()}, {from_low.data(), from_low.size()}},
        {high, upwards, 0, {up.data(), up.size()}, {}},
        {high, 0, downwards, {}, {from_high.data(), from_high.size()}}};
    communicator.exchange(space, messages);
    EXPECT_EQ(to_high(low), values_of(from_low));
    EXPECT_EQ(to_low(high), values_of(from_high));
    Kokkos::deep_copy(space, from_low, -1.0);
    Kokkos::deep_copy(space, from_high, -1.0);
    communicator.begin(space, messages);
    communicator.finish(space);
    EXPECT_EQ(to_high(low), values_of(from_low));
    EXPECT_EQ(to_low(high), values_of(from_high));
  });
}

TEST_F(DeviceCommunicatorRanks, GathersInTheOrderOfTheRanks) {
  for_each_communicator([](const Communicator& communicator) {
    const ExecutionSpace space;
    for (const std::size_t count : {1U, 7U, 3000U}) {
      const auto numbers = [&](int of) {
        std::vector<double> values(count);
        for (std::size_t i = 0; i < count; ++i) values[i] = 1000.0 * of + static_cast<double>(i);
        return values;
      };
      std::vector<double> expected, blank(count * static_cast<std::size_t>(communicator.size()), -1.0);
      for (int of = 0; of < communicator.size(); ++of)
        for (const double value : numbers(of)) expected.push_back(value);
      const List mine = list_of(numbers(communicator.rank())), all = list_of(blank);
      communicator.gather(space, mine.data(), all.data(), count);
      EXPECT_EQ(expected, values_of(all));
      const std::size_t begin = count * static_cast<std::size_t>(communicator.rank());
      for (std::size_t i = 0; i < count; ++i) blank[begin + i] = expected[begin + i];
      const List in_place = list_of(blank);
      communicator.gather(space, in_place.data() + begin, in_place.data(), count);
      EXPECT_EQ(expected, values_of(in_place));
    }
  });
}

TEST_F(DeviceCommunicatorRanks, FindsMaximaOfIntegersOf64Bits) {
  for_each_communicator([](const Communicator& communicator) {
    const ExecutionSpace space;
    const auto rank = static_cast<std::uint64_t>(communicator.rank()),
               last = static_cast<std::uint64_t>(communicator.size() - 1);
    constexpr std::uint64_t large = std::uint64_t{1} << 63U;
    const Kokkos::View<std::uint64_t*, ExecutionSpace::memory_space> values("test", 3);
    std::vector<std::uint64_t> numbers = {large + rank, large - rank, 7};
    device::copy_in(space, values, numbers.data(), numbers.size());
    space.fence();
    communicator.maximize(space, {values.data(), values.size()});
    device::copy_out(space, numbers.data(), values, numbers.size());
    space.fence();
    EXPECT_EQ((std::vector<std::uint64_t>{large + last, large, 7}), numbers);
  });
}

TEST_F(DeviceCommunicatorRanks, RejectsATransportThatTheRanksLack) {
  const ExecutionSpace space;
  const RankGroup world = RankGroup::world();
  std::vector<std::string> lacking = {"", "carrier-pigeon", "none"};
  lacking[0] = device::is_host<ExecutionSpace> ? "nccl" : "mpi";
  for (const std::string& transport : lacking) {
    setenv(variable, transport.c_str(), 1);
    try {
      const Communicator communicator(space, world);
      ADD_FAILURE() << transport;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("host-staging"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace drogue::linear
