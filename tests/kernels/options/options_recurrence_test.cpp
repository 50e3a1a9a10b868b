#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kernels/options/pide/register_march.hpp"
#include "tests/support/options_numbers.hpp"

// Recurrences over lanes and parts of blocks against sequential recurrences.

namespace drogue::options {
namespace {

using Space = DROGUE_TEST_SPACE;
using Numbers = DeviceNumbers<Space>;
using R = Number<Space>;
constexpr int members = device::Access<R>::lanes;

enum class Storage { in_memory, in_registers, halved };

/// Both recurrences of one line with `block` nodes per lane; changes y in place.
struct RecurrenceFunctor {
  Storage storage;
  int block, end;
  double below, above, x0;
  Numbers x, y, floor, scratch;

  KOKKOS_FUNCTION void operator()(const Kokkos::TeamPolicy<Space>::member_type& team) const {
    if constexpr (device::is_host<Space>) {
      recur_on(SerialThreadGroup<R>{});
    } else {
      const auto rank = static_cast<int>(team.team_rank());
      if (storage == Storage::in_memory) return recur_on(WarpThreadGroup<>{rank});
      if (storage == Storage::halved) return in_registers<max_lanes, 4, true>(rank);
      if (block == 8) return in_registers<max_lanes, 8, false>(rank);
      in_registers<max_lanes, 4, false>(rank);
    }
  }

 private:
  template <class ThreadGroup>
  KOKKOS_FUNCTION void recur_on(const ThreadGroup& group) const {
    auto* const line = reinterpret_cast<R*>(y.data());
    auto* const work = reinterpret_cast<R*>(scratch.data());
    recur_backward(group, {line}, block, R(above), work);
    recur_forward(group, reinterpret_cast<R*>(x.data()), line, reinterpret_cast<const R*>(floor.data()),
                  block, end, R(below), R(x0), work);
  }
  template <int lanes, int nodes, bool halved>
  KOKKOS_FUNCTION void in_registers(int lane) const {
    auto line = LaneNodes<nodes>::load(lane, y.data());
    const auto least = LaneNodes<nodes>::load(lane, floor.data());
    recur_backward<lanes, halved>(lane, line, above);
    (below >= 0.0 ? recur_by_maps<lanes, MaxAffineMap<double>, halved>(lane, line, least, below, x0)
                  : recur_by_maps<lanes, ClampedMap<double>, halved>(lane, line, least, below, x0))
        .store(lane, x.data());
  }
};

/// Random right-hand sides, and lower bounds that are active at some nodes. Node 0 is given, nodes from `end`
/// on are 0.
void expect_plain_recurrences(Storage storage, int block, int end, double below, double above) {
  SCOPED_TRACE("block " + std::to_string(block) + ", end " + std::to_string(end) + ", slopes " +
               std::to_string(below) + " and " + std::to_string(above));
  const auto nodes = static_cast<std::size_t>(block * max_lanes);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<double> y(nodes), floor(nodes), wide(nodes * members), wide_floor(nodes * members);
  for (std::size_t i = 0; i < nodes; ++i) {
    y[i] = part(random);
    floor[i] = part(random) > 0.0 ? part(random) : -unbounded;
    std::fill_n(wide.begin() + static_cast<std::ptrdiff_t>(i * members), members, y[i]);
    std::fill_n(wide_floor.begin() + static_cast<std::ptrdiff_t>(i * members), members, floor[i]);
  }
  constexpr double x0 = 0.7;
  const Numbers x("x", nodes * members);
  Kokkos::parallel_for(
      "recurrence_test", Kokkos::TeamPolicy<Space>(1, device::is_host<Space> ? 1 : max_lanes),
      RecurrenceFunctor{storage, block, end, below, above, x0, x, on_backend<Space>(wide),
                        on_backend<Space>(wide_floor), Numbers("scratch", 9 * max_lanes * members)});
  for (std::size_t i = nodes - 1; i-- > 0;) y[i] += above * y[i + 1];
  std::vector<double> plain(nodes, x0);
  for (std::size_t i = 1; i < nodes; ++i) plain[i] = std::max(floor[i], below * plain[i - 1] + y[i]);
  const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, x);
  double worst = 0.0;
  for (std::size_t i = 0; i < nodes; ++i)
    for (std::size_t k = 0; k < members; ++k)
      worst =
          std::max(worst, std::abs(found(i * members + k) - (static_cast<int>(i) < end ? plain[i] : 0.0)));
  EXPECT_LT(worst, 1e-13);
}

TEST(OptionsRecurrence, BlockedRecurrencesMatchSequentialOnes) {
  for (const double below : {0.9, 0.3, 0.0, -0.6})
    for (const double above : {0.8, 0.1}) {
      for (const int block : {1, 4, 7, 8, 9, 16}) {
        expect_plain_recurrences(Storage::in_memory, block, block * max_lanes, below, above);
        expect_plain_recurrences(Storage::in_memory, block, block * max_lanes - 3, below, above);
      }
      if (device::is_host<Space>) continue;
      expect_plain_recurrences(Storage::in_registers, 8, 8 * max_lanes, below, above);
      expect_plain_recurrences(Storage::in_registers, 4, 4 * max_lanes, below, above);
      expect_plain_recurrences(Storage::halved, 4, 4 * max_lanes, below, above);
    }
}

}  // namespace
}  // namespace drogue::options
