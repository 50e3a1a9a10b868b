#include <gtest/gtest.h>
#include <Kokkos_Core.hpp>

#include <array>
#include <atomic>
#include <barrier>
#include <cstdint>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

// Warps of 32 lanes in waves of 64 lanes: the code that HIP compiles for a device runs here on threads, each
// of which is a lane. The intrinsics are those of HIP 5.2.3 (amd_warp_functions.h), with what a wave leaves
// undefined made visible: a lane never waits for the other half of its wave, which may be in another branch,
// and gets no value from there.

namespace {

constexpr int team = 64, half = 32;

std::array<std::uint64_t, team> sent;
std::barrier<> barriers[] = {std::barrier(half), std::barrier(half)};
std::atomic<int> crossings;  ///< reads from the other half
thread_local int rank, wave;

int __lane_id() { return rank % wave; }  // NOLINT: the names are those of HIP

void __builtin_amdgcn_wave_barrier() { barriers[rank / half].arrive_and_wait(); }  // NOLINT
#define __builtin_amdgcn_fence(order, scope)
#define __builtin_assume(condition) static_cast<void>(condition)
#define __device__

/// Value of another lane of the wave, or of this one if the other one is in the other half.
template <class T>
T permute(T value, int lane) {
  static_assert(sizeof(T) <= sizeof(std::uint64_t));
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof value);
  sent[static_cast<std::size_t>(rank)] = bits;
  __builtin_amdgcn_wave_barrier();
  const int from = rank / wave * wave + lane;
  if (lane < 0 || lane >= wave || from / half != rank / half)
    ++crossings;
  else
    std::memcpy(&value, &sent[static_cast<std::size_t>(from)], sizeof value);
  __builtin_amdgcn_wave_barrier();
  return value;
}
template <class T>
T __shfl(T value, int lane, int width) {  // NOLINT
  return permute(value, lane + (__lane_id() & ~(width - 1)));
}
template <class T>
T __shfl_up(T value, unsigned offset, int width) {  // NOLINT
  const int self = __lane_id(), index = self - static_cast<int>(offset);
  return permute(value, index < (self & ~(width - 1)) ? self : index);
}
template <class T>
T __shfl_down(T value, unsigned offset, int width) {  // NOLINT
  const int self = __lane_id(), index = self + static_cast<int>(offset);
  return permute(value, (self & (width - 1)) + static_cast<int>(offset) >= width ? self : index);
}
template <class T>
T __shfl_xor(T value, int mask, int width) {  // NOLINT
  const int self = __lane_id(), index = self ^ mask;
  return permute(value, index >= ((self + width) & ~(width - 1)) ? self : index);
}
/// Bits of the other half are arbitrary.
std::uint64_t __ballot(int predicate) {  // NOLINT
  std::uint64_t bits = 0;
  for (int lane = 0; lane < wave; ++lane) {
    const bool is_own = lane / half == __lane_id() / half;
    const bool bit = is_own ? permute(predicate, lane) != 0 : lane % 3 == 0;
    bits |= std::uint64_t{bit} << static_cast<unsigned>(lane);
  }
  return bits;
}

}  // namespace

// The device code of HIP in a namespace of its own, since other sources of this program have that of hosts.
#define drogue drogue_on_waves
#undef KOKKOS_IF_ON_DEVICE
#undef KOKKOS_IF_ON_HOST
#define KOKKOS_IF_ON_DEVICE(CODE) KOKKOS_IMPL_STRIP_PARENS(CODE)
#define KOKKOS_IF_ON_HOST(CODE)
#define KOKKOS_ENABLE_HIP
#include "kernels/device/warp.hpp"
#undef KOKKOS_ENABLE_HIP
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/options/pide/recurrence.hpp"

namespace drogue {
namespace {

/// Calls `function(rank)` on the threads of a team, in waves of `lanes`.
template <class Function>
void run_team(int lanes, const Function& function) {
  crossings = 0;
  std::vector<std::thread> threads;
  for (int own = 0; own < team; ++own)
    threads.emplace_back([&, own] {
      rank = own;
      wave = lanes;
      function(own);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(0, crossings) << "waves of " << lanes;
}

std::vector<double> random_numbers(std::size_t count, double low, double high) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = uniform(random);
  return numbers;
}

constexpr int block = 8, nodes = options::max_lanes * block;

/// Both recurrences of two options at once, of 256 nodes each, on one thread (`lanes` is 0) or on two warps.
template <bool halved>
std::vector<double> recurrences(int lanes, double below) {
  using namespace options;
  constexpr double above = 0.7, start = 0.9;
  constexpr int of_thread = halved ? block / 2 : block, count = of_thread * max_lanes;
  std::vector<double> y = random_numbers(2 * count, -1.0, 1.0), floor(y.size(), -0.2), x(y.size());
  if (lanes == 0) {
    std::vector<double> work(3 * 3 * max_lanes);
    const SerialThreadGroup<double> group;
    for (int option = 0; option < 2; ++option) {
      double* const line = y.data() + option * count;
      recur_backward(group, {line}, of_thread, above, work.data());
      recur_forward(group, x.data() + option * count, line, floor.data(), of_thread, count, below, start,
                    work.data());
    }
    return x;
  }
  run_team(lanes, [&](int thread) {
    const int lane = thread % max_lanes, first = thread / max_lanes * count;
    auto line = LaneNodes<of_thread>::load(lane, y.data() + first);
    const auto least = LaneNodes<of_thread>::load(lane, floor.data());
    recur_backward<max_lanes, halved>(lane, line, above);
    (below >= 0.0 ? recur_by_maps<max_lanes, MaxAffineMap<double>, halved>(lane, line, least, below, start)
                  : recur_by_maps<max_lanes, ClampedMap<double>, halved>(lane, line, least, below, start))
        .store(lane, x.data() + first);
  });
  return x;
}

TEST(Wave, RecurrencesOfTwoWarps) {
  for (const double below : {0.6, -0.3}) {
    EXPECT_EQ(recurrences<false>(0, below), recurrences<false>(half, below));
    EXPECT_EQ(recurrences<false>(0, below), recurrences<false>(team, below));
    EXPECT_EQ(recurrences<true>(half, below), recurrences<true>(team, below));
  }
}

TEST(Wave, ReductionsStayInTheirWarp) {
  using namespace options;
  const std::vector<double> numbers = random_numbers(team, -1.0, 1.0);
  const auto of = [&](int first) {
    return [&, first](int lane) { return std::array{numbers[static_cast<std::size_t>(first + lane)]}; };
  };
  for (const int lanes : {half, team}) {
    std::array<double, team> whole{}, quarter{};
    std::array<int, team> all{}, largest{};
    std::array<unsigned, team> mask{};
    run_team(lanes, [&](int thread) {
      const auto t = static_cast<std::size_t>(thread);
      whole[t] = sums(WarpThreadGroup<>(thread), of(thread / 32 * 32))[0];
      quarter[t] = minima(WarpThreadGroup<16>(thread), of(thread / 16 * 16))[0];
      all[t] = device::warp_all(thread != 5) ? 1 : 0;
      largest[t] = device::warp_maximum<16>(thread * 7 % 64);
      mask[t] = device::warp_ballot(thread % 5 == 0);
    });
    for (int thread = 0; thread < team; ++thread) {
      const auto t = static_cast<std::size_t>(thread);
      EXPECT_EQ(sums(SerialThreadGroup<double>{}, of(thread / 32 * 32))[0], whole[t]);
      EXPECT_EQ(minima(SerialThreadGroup<double>{16}, of(thread / 16 * 16))[0], quarter[t]);
      EXPECT_EQ(thread < half ? 0 : 1, all[t]);
      int greatest = 0;
      unsigned bits = 0;
      for (int other = 0; other < team; ++other) {
        if (other / 16 == thread / 16) greatest = std::max(greatest, other * 7 % 64);
        if (other / half == thread / half && other % 5 == 0)
          bits |= 1U << static_cast<unsigned>(other % half);
      }
      EXPECT_EQ(greatest, largest[t]);
      EXPECT_EQ(bits, mask[t]);
    }
  }
}

TEST(Wave, LanesBeyondTheirWarpWrap) {
  for (const int lanes : {half, team}) {
    std::array<double, team> before{}, after{};
    run_team(lanes, [&](int thread) {
      const int lane = thread % half;
      before[static_cast<std::size_t>(thread)] = device::shuffle(thread, lane - 1);
      after[static_cast<std::size_t>(thread)] = device::shuffle(thread, lane + 1);
    });
    for (int thread = 0; thread < team; ++thread) {
      const int first = thread / half * half;
      EXPECT_EQ(first + (thread - first + half - 1) % half, before[static_cast<std::size_t>(thread)]);
      EXPECT_EQ(first + (thread - first + 1) % half, after[static_cast<std::size_t>(thread)]);
    }
  }
}

/// Springs of 64 vertices, of which some have rows that a warp shares. The halves of a wave have rows of
/// other lengths, and so take other branches.
TEST(Wave, SpringsOfLongRows) {
  using namespace fabric;
  constexpr ConstitutiveModel model{Model::edge};
  struct Fabric {
    SlicedEllViews<Kokkos::Serial, 2> springs;
  };
  const int lengths[] = {14, 46};
  const int slots = (lengths[0] + lengths[1]) * slice;
  Fabric of{{Kokkos::View<int*, Kokkos::HostSpace>("first", 3),
             Kokkos::View<int*, Kokkos::HostSpace>("neighbour", slots),
             Kokkos::View<double* [2], Kokkos::LayoutLeft, Kokkos::HostSpace>("value", slots)}};
  of.springs.first(1) = lengths[0];
  of.springs.first(2) = lengths[0] + lengths[1];
  const std::vector<double> numbers =
      random_numbers(static_cast<std::size_t>(2 * slots + 3 * team), 0.5, 1.5);
  for (int vertex = 0; vertex < team; ++vertex)
    for (int k = 0; k < lengths[vertex / slice]; ++k) {
      const int slot = (of.springs.first(vertex / slice) + k) * slice + vertex % slice;
      const bool is_spring = k < 9 || vertex == 3 || vertex == 30 || vertex == 40 || vertex == 63;
      of.springs.neighbour(slot) = is_spring ? (vertex + k + 1) % team : vertex;
      of.springs.value(slot, 0) = is_spring ? numbers[static_cast<std::size_t>(slot)] : 0.0;
      of.springs.value(slot, 1) = is_spring ? numbers[static_cast<std::size_t>(slots + slot)] : 0.0;
    }
  Kokkos::View<double* [3], Kokkos::LayoutLeft, Kokkos::HostSpace> at("at", team);
  for (int i = 0; i < 3 * team; ++i) at.data()[i] = numbers[static_cast<std::size_t>(2 * slots + i)];
  for (const int lanes : {half, team}) {
    std::array<Vector3<double>, team> sum{};
    run_team(lanes, [&](int vertex) {
      sum[static_cast<std::size_t>(vertex)] =
          with_springs_of_warp<model>(of.springs, at, vertex, {1.0, 2.0, 3.0});
    });
    for (int vertex = 0; vertex < team; ++vertex) {
      const Vector3<double> expected = with_springs<model>(of, at, vertex, Vector3<double>{1.0, 2.0, 3.0});
      EXPECT_EQ(expected.x, sum[static_cast<std::size_t>(vertex)].x) << vertex;
      EXPECT_EQ(expected.y, sum[static_cast<std::size_t>(vertex)].y) << vertex;
      EXPECT_EQ(expected.z, sum[static_cast<std::size_t>(vertex)].z) << vertex;
    }
  }
}

}  // namespace
}  // namespace drogue
