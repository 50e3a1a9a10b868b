#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/options/transforms/register_fourier.hpp"
#include "kernels/options/transforms/shared_fourier.hpp"
#include "tests/support/options_numbers.hpp"

// Sums over jumps by Fourier transforms against direct sums.

namespace drogue::options {
namespace {

using Space = DROGUE_TEST_SPACE;
using Numbers = DeviceNumbers<Space>;
using R = Number<Space>;
constexpr int members = device::Access<R>::lanes;

enum class Storage { in_memory, in_registers, shared };

/// Two groups of 16 lanes share a warp and sum in separate memory; the result of the first one is checked.
/// With `Storage::shared` all threads of a warp share octets.
struct SumFunctor {
  int mesh, lanes;
  Storage storage;
  Numbers weights, values, sums, roots, spectrum, work;

  KOKKOS_FUNCTION void operator()(const Kokkos::TeamPolicy<Space>::member_type& team) const {
    if constexpr (device::is_host<Space>) {
      sum_on(SerialThreadGroup<R>{lanes}, 0);
    } else {
      const auto rank = static_cast<int>(team.team_rank());
      if (storage == Storage::shared) return sum_on(WarpThreadGroup<max_lanes / 2, true>{rank}, 0);
      if (lanes == max_lanes) return sum_on(WarpThreadGroup<>{rank}, 0);
      sum_on(WarpThreadGroup<max_lanes / 2>{rank % lanes}, rank / lanes);
    }
  }

 private:
  template <class ThreadGroup>
  KOKKOS_FUNCTION void sum_on(const ThreadGroup& group, int pack) const {
    const auto* const w = reinterpret_cast<const R*>(weights.data());
    const auto* const v = reinterpret_cast<const R*>(values.data());
    auto* const to = reinterpret_cast<R*>(sums.data()) + pack * mesh;
    auto* const z = reinterpret_cast<ComplexNumber<R>*>(work.data()) + pack * padded(mesh);
    auto* const place = reinterpret_cast<ComplexNumber<R>*>(spectrum.data()) + pack * padded(mesh);
    const JumpSpectrum<R> made = spectrum_of(group, mesh, FourierRoots::from_table(roots.data()), w, place);
    if constexpr (!device::is_host<Space>) {
      if constexpr (ThreadGroup::is_single) {
        const WarpThreadGroup<> threads(group.thread);
        const auto own = LaneNodes<4>::load(group.thread, v);
        const auto sum = SharedFourier(group.thread, made, to, z)(threads, own);
        threads.sync();  // the two halves of a lane have swizzled places in common
        return sum.store(group.thread, to);
      } else if (storage == Storage::in_registers) {
        const auto own = LaneNodes<8>::load(group.lane, v);
        return RegisterFourier<ThreadGroup::lanes>(group.lane, made, to, z)(group, own).store(group.lane, to);
      }
    }
    sum_by_transforms(group, mesh, made, v, to, z);
  }
};

/// Random values, and weights that decay like those of jumps, with other magnitudes for each member of a
/// pack.
void expect_plain_sums(int mesh, int lanes, Storage storage) {
  const WeightLayout<R> layout(mesh);
  std::vector<double> w(static_cast<std::size_t>(layout.size() * members)),
      v(static_cast<std::size_t>(mesh * members));
  const auto weight = [&](int d, int k) -> double& {
    return w[static_cast<std::size_t>(layout.place(d) * members + k)];
  };
  const auto value = [&](int i, int k) -> double& { return v[static_cast<std::size_t>(i * members + k)]; };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<double> all(members, 0.0);  // sum of the weights
  for (int k = 0; k < members; ++k) {
    for (int d = 1 - mesh; d < mesh; ++d) {
      weight(d, k) = d == 0 ? 0.0 : std::pow(100.0, k) * part(random) / (double(d) * d);
      all[static_cast<std::size_t>(k)] += weight(d, k);
    }
    for (int i = 0; i < mesh; ++i) value(i, k) = part(random);
  }
  const auto packs = static_cast<std::size_t>(max_lanes / lanes),
             room = packs * static_cast<std::size_t>(2 * padded(mesh) * members);
  const Numbers sums("sums", packs * v.size());
  const SumFunctor functor{mesh,
                           lanes,
                           storage,
                           on_backend<Space>(w),
                           on_backend<Space>(v),
                           sums,
                           on_backend<Space>(fourier_roots()),
                           Numbers("spectrum", room),
                           Numbers("work", room)};
  Kokkos::parallel_for("sum_test", Kokkos::TeamPolicy<Space>(1, device::is_host<Space> ? 1 : max_lanes),
                       functor);
  const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, sums);
  for (int k = 0; k < members; ++k) {
    double worst = 0.0;
    for (int i = 0; i < mesh; i += 5) {
      double sum = 0.0;
      for (int j = 0; j < mesh; ++j) sum += weight(j - i, k) * value(j, k);
      worst = std::max(worst, std::abs(found(i * members + k) - sum));
    }
    EXPECT_LT(worst, 3e-14 * all[static_cast<std::size_t>(k)]) << "mesh " << mesh << ", member " << k;
  }
}

TEST(OptionsSum, TransformsMatchDirectSums) {
  for (const int mesh : {256, 512, 1024, 2048, 4096}) {
    ASSERT_TRUE(is_transformed(mesh, max_lanes));
    expect_plain_sums(mesh, max_lanes, Storage::in_memory);
  }
  EXPECT_FALSE(is_transformed(128, max_lanes) || is_transformed(384, 16));
  ASSERT_TRUE(is_transformed(128, lanes_of(128)));
  expect_plain_sums(128, lanes_of(128), Storage::in_memory);
  if (device::is_host<Space>) return;
  expect_plain_sums(256, max_lanes, Storage::in_registers);
  expect_plain_sums(128, lanes_of(128), Storage::in_registers);
  expect_plain_sums(128, lanes_of(128), Storage::shared);
}

}  // namespace
}  // namespace drogue::options
