#include "kernels/device/pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/device/memory.hpp"

// Reciprocals and roots are IEEE operations, or hardware approximations improved by Newton steps; both are
// accurate.

namespace drogue::device {
namespace {

using Space = DROGUE_TEST_SPACE;
using R = std::conditional_t<is_host<Space>, HostPack<double>, double>;
using Values = Kokkos::View<double* [4], Kokkos::LayoutLeft, Space::memory_space>;

/// Column 0 holds x; writes 1/x, sqrt(x) and 1/sqrt(x) to columns 1 to 3.
struct RootFunctor {
  Values values;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * Access<R>::lanes;
    const R x = Access<R>::load(&values(i, 0));
    const Root<R> of_x = root(x);
    Access<R>::store(&values(i, 1), reciprocal(x));
    Access<R>::store(&values(i, 2), of_x.value);
    Access<R>::store(&values(i, 3), of_x.inverse);
  }
};

TEST(Pack, ReciprocalAndRootsAreAccurateToTwoUlp) {
  constexpr int n = 4096;
  const Values values("values", n);
  const auto host = Kokkos::create_mirror_view(values);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> mantissa(1.0, 2.0), exponent(-300.0, 300.0);
  for (int i = 0; i < n; ++i) host(i, 0) = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
  Kokkos::deep_copy(values, host);
  Kokkos::parallel_for("roots", Kokkos::RangePolicy<Space>(0, n / Access<R>::lanes), RootFunctor{values});
  Kokkos::deep_copy(host, values);
  const double ulp = std::ldexp(1.0, -52);
  double worst[3] = {};
  for (int i = 0; i < n; ++i) {
    const long double x = host(i, 0), exact[] = {1.0L / x, std::sqrt(x), 1.0L / std::sqrt(x)};
    for (int k = 0; k < 3; ++k)
      worst[k] = std::max(worst[k], static_cast<double>(std::fabs(host(i, k + 1) / exact[k] - 1.0L)));
  }
  EXPECT_LE(worst[0], ulp);
  EXPECT_LE(worst[1], 2.0 * ulp);
  EXPECT_LE(worst[2], 2.0 * ulp);
}

}  // namespace
}  // namespace drogue::device
