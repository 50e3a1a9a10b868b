#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "kernels/device/instance.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"
#include "perf/ceilings/ceilings.hpp"

namespace drogue::perf {

/// Work tags of the functors of all ceilings: initial values, the measured kernel, the comparison.
struct CeilingFill {};
struct CeilingRun {};
struct CeilingCheck {};

/// Types and helpers of the functors of all ceilings.
template <class ExecutionSpace>
struct CeilingTypes {
  static constexpr bool on_host = device::is_host<ExecutionSpace>;
  using R = std::conditional_t<on_host, device::HostPack<double>, double>;
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  static constexpr int lanes = device::Access<R>::lanes;

  static View allocate(std::int64_t values) {
    return View(Kokkos::view_alloc(Kokkos::WithoutInitializing, "drogue::perf::ceiling"),
                static_cast<std::size_t>(values));
  }

  /// Raises `worst` to the relative difference; a difference that is not finite counts as 1e300.
  KOKKOS_FUNCTION static void compare(double got, double expected, double& worst) {
    const double difference = Kokkos::fabs(got - expected) / (1.0 + expected);
    worst = device::maximum(worst, difference < 1e300 ? difference : 1e300);
  }
};

/// x <- a x + b, repeated `steps` times in `chains` independent chains per item; their sum is stored. With
/// a = 1 - b and b = 1/steps, a chain that starts at x ends at 1 + (x - 1) a^steps, close to 1 + (x - 1)/e.
template <class ExecutionSpace>
struct FmaChainsFunctor : CeilingTypes<ExecutionSpace> {
  using Types = CeilingTypes<ExecutionSpace>;
  using R = typename Types::R;
  static constexpr int lanes = Types::lanes;
  // A core has two units with a latency of four to five cycles; a GPU hides latency by switching warps.
  static constexpr int chains = Types::on_host ? 12 : 8;
  static constexpr std::int64_t steps = std::int64_t{1} << (Types::on_host ? 20 : 17);
  static constexpr double b = 1.0 / static_cast<double>(steps), a = 1.0 - b;

  std::int64_t items;  ///< number of threads that run concurrently
  typename Types::View sum;

  explicit FmaChainsFunctor(int threads) : items(threads), sum(Types::allocate(items * lanes)) {}

  [[nodiscard]] std::int64_t values() const { return items * lanes; }
  [[nodiscard]] double flops() const { return 2.0 * chains * steps * static_cast<double>(values()); }
  [[nodiscard]] double bytes() const { return 8.0 * static_cast<double>(values()); }

  KOKKOS_FUNCTION static double first(int chain) { return 2.0 + chain; }

  KOKKOS_FUNCTION void operator()(CeilingFill, std::int64_t i) const { sum(i) = 0.0; }

  KOKKOS_FUNCTION void operator()(CeilingRun, std::int64_t item) const {
    const R factor(a), term(b);
    R x[chains];
    for (int c = 0; c < chains; ++c) x[c] = R(first(c));
    for (std::int64_t step = 0; step < steps; ++step)
      for (int c = 0; c < chains; ++c) x[c] = factor * x[c] + term;
    R total = x[0];
    for (int c = 1; c < chains; ++c) total += x[c];
    device::Access<R>::store(sum.data() + item * lanes, total);
  }

  KOKKOS_FUNCTION void operator()(CeilingCheck, std::int64_t i, double& worst) const {
    double expected = 0.0;
    for (int c = 0; c < chains; ++c)
      expected += 1.0 + (first(c) - 1.0) * Kokkos::exp(static_cast<double>(steps) * Kokkos::log1p(-b));
    Types::compare(sum(i), expected, worst);
  }
};

/// a = b + s c; the three arrays of `items` packs share one View.
template <class ExecutionSpace>
struct TriadFunctor : CeilingTypes<ExecutionSpace> {
  using Types = CeilingTypes<ExecutionSpace>;
  using R = typename Types::R;
  static constexpr int lanes = Types::lanes;

  std::int64_t length, items;
  double s = 3.0;
  typename Types::View arrays;

  /// Allocates 0.4 GB or 50 MB per core, whichever is more; on a device 1.6 GB.
  explicit TriadFunctor(int threads)
      : length(Types::on_host ? std::max(std::int64_t{1} << 24, std::int64_t{threads} << 21)
                              : std::int64_t{1} << 26),
        items(length / lanes),
        arrays(Types::allocate(3 * length)) {}

  [[nodiscard]] std::int64_t values() const { return length; }
  [[nodiscard]] double flops() const { return 2.0 * static_cast<double>(length); }
  [[nodiscard]] double bytes() const { return 24.0 * static_cast<double>(length); }

  KOKKOS_FUNCTION void operator()(CeilingFill, std::int64_t i) const {
    arrays(i) = 0.0;
    arrays(length + i) = static_cast<double>(i);
    arrays(2 * length + i) = 2.0 * static_cast<double>(i);
  }
  KOKKOS_FUNCTION void operator()(CeilingRun, std::int64_t item) const {
    double* a = arrays.data() + item * lanes;
    device::Access<R>::store(
        a, device::Access<R>::load(a + length) + s * device::Access<R>::load(a + 2 * length));
  }
  KOKKOS_FUNCTION void operator()(CeilingCheck, std::int64_t i, double& worst) const {
    Types::compare(arrays(i), 7.0 * static_cast<double>(i), worst);
  }
};

/// y = x + s c with x and y exchanged after each of `passes` passes. Each item owns its values; value k ends
/// at x_k (1 + passes).
template <class ExecutionSpace>
struct CacheFunctor : CeilingTypes<ExecutionSpace> {
  using Types = CeilingTypes<ExecutionSpace>;
  using R = typename Types::R;
  static constexpr std::int64_t passes = std::int64_t{1} << (Types::on_host ? 14 : 10);

  std::int64_t items;
  std::int64_t row;  ///< values of x, of y and of c: together 24 kB per host thread, 25 MB on a device
  double s = 0.5;
  typename Types::View rows;  ///< x, y, c; on the host one such triple per item

  explicit CacheFunctor(int threads)
      : items(threads),
        row(std::int64_t{1} << (Types::on_host ? 10 : 20)),
        rows(Types::allocate(3 * values())) {}

  [[nodiscard]] std::int64_t values() const { return Types::on_host ? items * row : row; }
  [[nodiscard]] double flops() const { return 2.0 * passes * static_cast<double>(values()); }
  [[nodiscard]] double bytes() const { return 24.0 * passes * static_cast<double>(values()); }

  /// Address of x of value `i`; y and c follow at distances of `row` and 2 `row`.
  KOKKOS_FUNCTION double* x(std::int64_t i) const { return rows.data() + i / row * 3 * row + i % row; }
  KOKKOS_FUNCTION static double first(std::int64_t i) { return static_cast<double>(i % 8); }

  KOKKOS_FUNCTION void operator()(CeilingFill, std::int64_t i) const {
    x(i)[0] = first(i);
    x(i)[row] = 0.0;
    x(i)[2 * row] = 2.0 * first(i);
  }

  KOKKOS_FUNCTION void operator()(CeilingRun, std::int64_t item) const {
    if constexpr (Types::on_host) {
      double *from = x(item * row), *to = from + row;
      const double* c = to + row;
      for (std::int64_t pass = 0; pass < passes; ++pass) {
        for (std::int64_t k = 0; k < row; k += Types::lanes)
          device::Access<R>::store(to + k,
                                   device::Access<R>::load(from + k) + s * device::Access<R>::load(c + k));
        Kokkos::kokkos_swap(from, to);
      }
    } else {
      // Volatile accesses bypass the L1 cache and keep the compiler from merging passes.
      volatile double *from = x(0), *to = from + row, *c = to + row;
      for (std::int64_t pass = 0; pass < passes; ++pass) {
        for (std::int64_t k = item; k < row; k += items) to[k] = from[k] + s * c[k];
        volatile double* swapped = from;
        from = to;
        to = swapped;
      }
    }
  }

  KOKKOS_FUNCTION void operator()(CeilingCheck, std::int64_t i, double& worst) const {
    Types::compare(*x(i), first(i) * static_cast<double>(1 + passes), worst);
  }
};

template <class ExecutionSpace, class Functor>
class CeilingKernelImpl final : public CeilingKernel {
 public:
  CeilingKernelImpl()
      : _instance(std::numeric_limits<int>::max()), _functor(_instance.space().concurrency()) {}

  void reset() override {
    Kokkos::parallel_for("drogue::perf::ceiling_fill", range<CeilingFill>(_functor.values()), _functor);
    _instance.space().fence("drogue::perf::ceiling: filled");
  }
  void run() override {
    Kokkos::parallel_for("drogue::perf::ceiling", range<CeilingRun>(_functor.items), _functor);
    _instance.space().fence("drogue::perf::ceiling: done");
  }
  double error() override {
    double worst = 0.0;
    Kokkos::parallel_reduce("drogue::perf::ceiling_check", range<CeilingCheck>(_functor.values()), _functor,
                            Kokkos::Max<double>(worst));
    return worst;
  }
  [[nodiscard]] double flops() const override { return _functor.flops(); }
  [[nodiscard]] double bytes() const override { return _functor.bytes(); }

 private:
  template <class Tag>
  auto range(std::int64_t end) const {
    return Kokkos::RangePolicy<ExecutionSpace, Tag>(_instance.space(), 0, end);
  }

  device::Instance<ExecutionSpace> _instance;
  Functor _functor;
};

template <class ExecutionSpace>
std::unique_ptr<CeilingKernel> make_ceiling(Ceiling ceiling) {
  if (ceiling == Ceiling::fp64)
    return std::make_unique<CeilingKernelImpl<ExecutionSpace, FmaChainsFunctor<ExecutionSpace>>>();
  if (ceiling == Ceiling::memory)
    return std::make_unique<CeilingKernelImpl<ExecutionSpace, TriadFunctor<ExecutionSpace>>>();
  return std::make_unique<CeilingKernelImpl<ExecutionSpace, CacheFunctor<ExecutionSpace>>>();
}

}  // namespace drogue::perf
