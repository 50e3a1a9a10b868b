#include "perf/ceilings/ceilings.hpp"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"
#include "perf/clocks/device_time.hpp"

namespace drogue::perf {

/// Work tags of the functors of all ceilings: initial values, the measured kernel, the comparison.
struct CeilingFill {};
struct CeilingRun {};
struct CeilingCheck {};

// A register holds twice as many single-precision numbers as `device::HostPack`, which matches lanes.
#if DROGUE_HOST_VECTORS
using WideSingle = device::Pack<float, 2 * device::host_lanes>;
#else
using WideSingle = float;
#endif

/// Types and helpers of the functors of all ceilings, with numbers of type T.
template <class ExecutionSpace, class T = double>
struct CeilingTypes {
  static constexpr bool on_host = device::is_host<ExecutionSpace>;
  using R = std::conditional_t<
      on_host, std::conditional_t<std::is_same_v<T, double>, device::HostPack<double>, WideSingle>, T>;
  using View = Kokkos::View<T*, typename ExecutionSpace::memory_space>;
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
/// Single precision has no digits for as small a b: it repeats a shorter sequence, each time from the result
/// of the one before plus 1.
template <class ExecutionSpace, class T>
struct FmaChainsFunctor : CeilingTypes<ExecutionSpace, T> {
  using Types = CeilingTypes<ExecutionSpace, T>;
  using R = typename Types::R;
  static constexpr int lanes = Types::lanes;
  // A core has two units with a latency of four to five cycles; a GPU hides latency by switching warps.
  static constexpr int chains = Types::on_host ? 12 : 8;
  static constexpr std::int64_t all_steps = std::int64_t{1} << (Types::on_host ? 20 : 17);
  static constexpr std::int64_t steps = std::is_same_v<T, double> ? all_steps : std::int64_t{1} << 12;
  static constexpr std::int64_t repeats = all_steps / steps;
  static constexpr double b = 1.0 / static_cast<double>(steps), a = 1.0 - b;

  std::int64_t items;  ///< number of threads that run concurrently
  typename Types::View sum;

  explicit FmaChainsFunctor(int threads) : items(threads), sum(Types::allocate(items * lanes)) {}

  [[nodiscard]] std::int64_t values() const { return items * lanes; }
  [[nodiscard]] double flops() const { return 2.0 * chains * all_steps * static_cast<double>(values()); }
  [[nodiscard]] double bytes() const { return sizeof(T) * static_cast<double>(values()); }
  [[nodiscard]] double instructions() const { return 0.0; }

  KOKKOS_FUNCTION static double first(int chain) { return 2.0 + chain; }
  /// Value of a chain after a run.
  KOKKOS_FUNCTION static double last(int chain) {
    double x = first(chain);
    for (std::int64_t repeat = 0; repeat < repeats; ++repeat) {
      x = 1.0 + (x - 1.0) * Kokkos::exp(static_cast<double>(steps) * Kokkos::log1p(-b));
      if (repeats > 1) x += 1.0;
    }
    return x;
  }

  KOKKOS_FUNCTION void operator()(CeilingFill, std::int64_t i) const { sum(i) = T(0); }

  KOKKOS_FUNCTION void operator()(CeilingRun, std::int64_t item) const {
    const R factor(static_cast<T>(a)), term(static_cast<T>(b));
    R x[chains];
    for (int c = 0; c < chains; ++c) x[c] = R(static_cast<T>(first(c)));
    for (std::int64_t repeat = 0; repeat < repeats; ++repeat) {
#if defined(__CUDA_ARCH__)
#pragma unroll 32  // the counter takes issue slots, too
#endif
      for (std::int64_t step = 0; step < steps; ++step)
        for (int c = 0; c < chains; ++c) x[c] = factor * x[c] + term;
      if constexpr (repeats > 1)
        for (int c = 0; c < chains; ++c) x[c] += R(T(1));
    }
    R total = x[0];
    for (int c = 1; c < chains; ++c) total += x[c];
    device::Access<R>::store(sum.data() + item * lanes, total);
  }

  KOKKOS_FUNCTION void operator()(CeilingCheck, std::int64_t i, double& worst) const {
    double expected = 0.0;
    for (int c = 0; c < chains; ++c) expected += last(c);
    Types::compare(static_cast<double>(sum(i)), expected, worst);
  }
};

/// x <- a x + b and a rotation of an integer in turn, in chains as above: a multiprocessor executes both
/// kinds in different units, so that the issue of instructions is the limit. On a device alone.
template <class ExecutionSpace>
struct IssueFunctor : CeilingTypes<ExecutionSpace, float> {
  using Types = CeilingTypes<ExecutionSpace, float>;
  using Chains = FmaChainsFunctor<ExecutionSpace, float>;
  static constexpr int chains = Chains::chains, bits = 32;

  std::int64_t items;
  int rotation = 5;  ///< bits; at run time, so that no compiler merges rotations
  typename Types::View sum;
  Kokkos::View<std::uint32_t*, typename ExecutionSpace::memory_space> rotated;

  explicit IssueFunctor(int threads)
      : items(threads),
        sum(Types::allocate(items)),
        rotated("drogue::perf::ceiling_rotated", static_cast<std::size_t>(threads)) {}

  [[nodiscard]] std::int64_t values() const { return items; }
  [[nodiscard]] double flops() const { return 2.0 * chains * Chains::all_steps * static_cast<double>(items); }
  [[nodiscard]] double bytes() const { return 8.0 * static_cast<double>(items); }
  [[nodiscard]] double instructions() const { return flops(); }

  KOKKOS_FUNCTION static std::uint32_t first(int chain) { return 0x9E3779B9U + static_cast<unsigned>(chain); }
  KOKKOS_FUNCTION static std::uint32_t turned(std::uint32_t word, int by) {
    KOKKOS_IF_ON_DEVICE((return __funnelshift_l(word, word, static_cast<unsigned>(by));))
    KOKKOS_IF_ON_HOST((return word << by % bits | word >> (bits - by % bits) % bits;))
  }

  KOKKOS_FUNCTION void operator()(CeilingFill, std::int64_t i) const { sum(i) = 0.0F, rotated(i) = 0U; }

  KOKKOS_FUNCTION void operator()(CeilingRun, std::int64_t item) const {
    const auto factor = static_cast<float>(Chains::a), term = static_cast<float>(Chains::b);
    float x[chains];
    std::uint32_t word[chains];
    for (int c = 0; c < chains; ++c) x[c] = static_cast<float>(Chains::first(c)), word[c] = first(c);
    for (std::int64_t repeat = 0; repeat < Chains::repeats; ++repeat) {
#if defined(__CUDA_ARCH__)
#pragma unroll 32
#endif
      for (std::int64_t step = 0; step < Chains::steps; ++step)
        for (int c = 0; c < chains; ++c) x[c] = factor * x[c] + term, word[c] = turned(word[c], rotation);
      for (int c = 0; c < chains; ++c) x[c] += 1.0F;
    }
    float total = x[0];
    std::uint32_t all = word[0];
    for (int c = 1; c < chains; ++c) total += x[c], all ^= word[c];
    sum(item) = total, rotated(item) = all;
  }

  KOKKOS_FUNCTION void operator()(CeilingCheck, std::int64_t i, double& worst) const {
    double expected = 0.0;
    std::uint32_t all = 0U;
    const auto by = static_cast<int>(Chains::all_steps * rotation % bits);
    for (int c = 0; c < chains; ++c) expected += Chains::last(c), all ^= turned(first(c), by);
    Types::compare(static_cast<double>(sum(i)), expected, worst);
    if (rotated(i) != all) worst = 1.0;
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
  [[nodiscard]] double instructions() const { return 0.0; }

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

/// Caches of a host whose bandwidth is measured.
enum class HostCache { l1, l2, l3 };

/// Bytes per thread of a host that leave its L2 cache: four times as many.
inline std::int64_t bytes_beyond_l2() { return 4 * sysconf(_SC_LEVEL2_CACHE_SIZE); }

/// True if the threads of a host find room for that in half of the L3 cache; false if the system does not
/// state the sizes.
inline bool fits_in_l3(std::int64_t threads) {
  return bytes_beyond_l2() > 0 && threads * bytes_beyond_l2() <= sysconf(_SC_LEVEL3_CACHE_SIZE) / 2;
}

/// y = x + s c with x and y exchanged after each of `passes` passes. Each item owns its values; value k ends
/// at x_k (1 + passes).
template <class ExecutionSpace>
struct CacheFunctor : CeilingTypes<ExecutionSpace> {
  using Types = CeilingTypes<ExecutionSpace>;
  using R = typename Types::R;

  std::int64_t items;
  std::int64_t row;  ///< values of x, of y and of c: in L1 together 24 kB per host thread, 25 MB on a device
  std::int64_t passes;  ///< even: the last one writes x
  double s = 0.5;
  typename Types::View rows;  ///< x, y, c; on the host one such triple per item

  explicit CacheFunctor(int threads, HostCache cache = HostCache::l1)
      : items(threads),
        row(row_in(cache)),
        passes(Types::on_host ? std::max(std::int64_t{2}, (std::int64_t{1} << 23) / row * 2) : 1024),
        rows(Types::allocate(3 * values())) {}

  /// 192 kB per thread leave the L1 cache and fit into the L2 cache of any core.
  static std::int64_t row_in(HostCache cache) {
    if (!Types::on_host) return std::int64_t{1} << 20;
    if (cache == HostCache::l3) return bytes_beyond_l2() / 24 / Types::lanes * Types::lanes;
    return std::int64_t{1} << (cache == HostCache::l1 ? 10 : 13);
  }

  [[nodiscard]] std::int64_t values() const { return Types::on_host ? items * row : row; }
  [[nodiscard]] double flops() const { return 2.0 * static_cast<double>(passes * values()); }
  [[nodiscard]] double bytes() const { return 24.0 * static_cast<double>(passes * values()); }
  [[nodiscard]] double instructions() const { return 0.0; }

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
  /// `more`: further arguments of the functor.
  template <class... More>
  explicit CeilingKernelImpl(More... more)
      : _instance(std::numeric_limits<int>::max()), _functor(_instance.space().concurrency(), more...) {}

  void reset() override {
    Kokkos::parallel_for("drogue::perf::ceiling_fill", range<CeilingFill>(_functor.values()), _functor);
    _instance.space().fence("drogue::perf::ceiling: filled");
  }
  void run() override {
    enqueue();
    _instance.space().fence("drogue::perf::ceiling: done");
  }
  double timed_run() override {
    return device_time(_instance.space(), [this] { enqueue(); });
  }
  double error() override {
    double worst = 0.0;
    Kokkos::parallel_reduce("drogue::perf::ceiling_check", range<CeilingCheck>(_functor.values()), _functor,
                            Kokkos::Max<double>(worst));
    return worst;
  }
  [[nodiscard]] double flops() const override { return _functor.flops(); }
  [[nodiscard]] double bytes() const override { return _functor.bytes(); }
  [[nodiscard]] double instructions() const override { return _functor.instructions(); }

 private:
  void enqueue() {
    Kokkos::parallel_for("drogue::perf::ceiling", range<CeilingRun>(_functor.items), _functor);
  }

  template <class Tag>
  auto range(std::int64_t end) const {
    return Kokkos::RangePolicy<ExecutionSpace, Tag>(_instance.space(), 0, end);
  }

  device::Instance<ExecutionSpace> _instance;
  Functor _functor;
};

/// Kernel that counts its launches and does nothing else.
template <class ExecutionSpace>
struct CountLaunchFunctor {
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> count;
  KOKKOS_FUNCTION void operator()(int i) const {
    if (i == 0) ++count();
  }
};

/// Launches of such a kernel with one item per host thread or one warp on a device, plain or in a graph.
template <class ExecutionSpace>
class LaunchKernel final : public CeilingKernel {
 public:
  explicit LaunchKernel(bool in_graph)
      : _instance(std::numeric_limits<int>::max()), _count("drogue::perf::ceiling_launches") {
    // The first launch of a kernel prepares it, which a capture may not.
    launch_all();
    _instance.space().fence("drogue::perf::ceiling: prepared");
    if (in_graph) _graph.emplace(_instance, [this](const ExecutionSpace&) { launch_all(); });
  }

  void reset() override {
    Kokkos::deep_copy(_instance.space(), _count, std::int64_t{0});
    _instance.space().fence("drogue::perf::ceiling: reset");
  }
  void run() override {
    enqueue();
    _instance.space().fence("drogue::perf::ceiling: launched");
  }
  double timed_run() override {
    return device_time(_instance.space(), [this] { enqueue(); });
  }
  double error() override {
    const auto count = Kokkos::create_mirror_view(_count);
    Kokkos::deep_copy(_instance.space(), count, _count);
    _instance.space().fence("drogue::perf::ceiling: counted");
    return std::abs(static_cast<double>(count() - launches()));
  }
  [[nodiscard]] long launches() const override { return 200; }
  [[nodiscard]] double flops() const override { return 0.0; }
  [[nodiscard]] double bytes() const override { return 0.0; }

 private:
  void enqueue() {
    if (_graph)
      _graph->launch();
    else
      launch_all();
  }

  void launch_all() {
    const int items = device::is_host<ExecutionSpace> ? _instance.space().concurrency() : 32;
    for (long k = 0; k < launches(); ++k)
      device::launch_each(_instance.space(), "drogue::perf::ceiling_launch", items,
                          CountLaunchFunctor<ExecutionSpace>{_count});
  }

  device::Instance<ExecutionSpace> _instance;
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> _count;
  std::optional<device::CapturedGraph<ExecutionSpace>> _graph;
};

/// True if an execution space has a ceiling on this machine. Does not throw.
template <class ExecutionSpace>
bool supports_ceiling(Ceiling ceiling) {
  constexpr bool on_host = device::is_host<ExecutionSpace>;
  if (ceiling == Ceiling::issue || ceiling == Ceiling::graph_node) return !on_host;
  // With threads on all processors, since Kokkos may not be initialised yet.
  if (ceiling == Ceiling::l3) return on_host && fits_in_l3(std::thread::hardware_concurrency());
  return ceiling != Ceiling::l2 || on_host;
}

/// Kernel of a ceiling. Throws std::invalid_argument if the execution space has none.
template <class ExecutionSpace>
std::unique_ptr<CeilingKernel> make_ceiling(Ceiling ceiling) {
  if (!supports_ceiling<ExecutionSpace>(ceiling))
    throw std::invalid_argument("this backend lacks the requested ceiling");
  using Chains = FmaChainsFunctor<ExecutionSpace, double>;
  using SingleChains = FmaChainsFunctor<ExecutionSpace, float>;
  using Cache = CacheFunctor<ExecutionSpace>;
  switch (ceiling) {
    case Ceiling::fp64:
      return std::make_unique<CeilingKernelImpl<ExecutionSpace, Chains>>();
    case Ceiling::fp32:
      return std::make_unique<CeilingKernelImpl<ExecutionSpace, SingleChains>>();
    case Ceiling::memory:
      return std::make_unique<CeilingKernelImpl<ExecutionSpace, TriadFunctor<ExecutionSpace>>>();
    case Ceiling::l2:
      return std::make_unique<CeilingKernelImpl<ExecutionSpace, Cache>>(HostCache::l2);
    case Ceiling::l3:
      return std::make_unique<CeilingKernelImpl<ExecutionSpace, Cache>>(HostCache::l3);
    case Ceiling::launch:
    case Ceiling::graph_node:
      return std::make_unique<LaunchKernel<ExecutionSpace>>(ceiling == Ceiling::graph_node);
    case Ceiling::issue:
      if constexpr (!device::is_host<ExecutionSpace>)
        return std::make_unique<CeilingKernelImpl<ExecutionSpace, IssueFunctor<ExecutionSpace>>>();
      [[fallthrough]];
    case Ceiling::cache:
      break;
  }
  return std::make_unique<CeilingKernelImpl<ExecutionSpace, Cache>>();
}

bool has_ceiling(device::Backend backend, Ceiling ceiling) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return supports_ceiling<ExecutionSpace>(ceiling); });
}

std::unique_ptr<CeilingKernel> create_ceiling(device::Backend backend, Ceiling ceiling) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_ceiling<ExecutionSpace>(ceiling); });
}

}  // namespace drogue::perf
