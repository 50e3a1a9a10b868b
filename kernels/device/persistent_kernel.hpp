#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/device/instance.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/device/team_maximum.hpp"

namespace drogue::device {

/// The one launcher that Kokkos lacks: a grid whose teams all run at once, so that a kernel may hold many
/// steps and teams may wait for one another. Only CUDA has it.
template <class ExecutionSpace>
class PersistentKernel {
 public:
  static constexpr bool available = false;
};

/// What a place of a grid's board holds.
struct HaloValue {
  double value[3];
};

#if defined(KOKKOS_ENABLE_CUDA)

/// A number that a team tells all others, with the epoch that it belongs to. Sixteen aligned bytes are read
/// and written at once by every GPU since Volta, which PTX promises only for its newer 128-bit type.
struct alignas(16) HaloMessage {
  std::uint64_t value, epoch;
};

/// What the teams of a persistent kernel know of one another. Epochs only rise, over all launches, so that
/// none has to begin by clearing them.
struct GridSync {
  std::uint64_t* published;  ///< (teams): epoch that a team has ended
  HaloMessage* packets;      ///< (2, teams): of even and of odd epochs
  HaloMessage* board;        ///< (2, 3, places): what neighbours read, of even and of odd epochs
  std::size_t places;
};

/// A team's member as kernels use Kokkos' own, and what lets teams wait for one another. On the host, where
/// none ever runs, its functions do nothing.
class PersistentMember {
 public:
  /// Teams that a warp can listen to at once.
  static constexpr int most_teams = 192;

  KOKKOS_FUNCTION PersistentMember(GridSync grid_sync, int team_rank, int team_size, int league_rank,
                                   int league_size)
      : _grid_sync(grid_sync),
        _team_rank(team_rank),
        _team_size(team_size),
        _league_rank(league_rank),
        _league_size(league_size) {}

  [[nodiscard]] KOKKOS_FUNCTION int team_rank() const { return _team_rank; }
  [[nodiscard]] KOKKOS_FUNCTION int team_size() const { return _team_size; }
  [[nodiscard]] KOKKOS_FUNCTION int league_rank() const { return _league_rank; }
  [[nodiscard]] KOKKOS_FUNCTION int league_size() const { return _league_size; }
  KOKKOS_FUNCTION void team_barrier() const { KOKKOS_IF_ON_DEVICE((__syncthreads();)) }

  /// Kokkos' own scratch handle hides from the compiler that its memory is shared memory.
  [[nodiscard]] KOKKOS_FUNCTION const PersistentMember& team_scratch(int) const { return *this; }
  KOKKOS_FUNCTION void* get_shmem_aligned(std::size_t bytes, std::size_t alignment) const {
    void* place = nullptr;
    KOKKOS_IF_ON_DEVICE((extern __shared__ double persistent_scratch[];
                         _used = (_used + alignment - 1) / alignment * alignment;
                         place = reinterpret_cast<char*>(persistent_scratch) + _used;))
    KOKKOS_IF_ON_HOST(((void)alignment;))
    _used += bytes;
    return place;
  }

  /// The epoch that this team, and so every team, has ended at the beginning of a launch.
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t epoch() const { return _grid_sync.published[_league_rank]; }

  /// Ends `epoch` for this team: one thread calls it after a barrier, and who awaits it sees what the team
  /// has written until then.
  KOKKOS_FUNCTION void publish(std::uint64_t epoch) const {
    KOKKOS_IF_ON_DEVICE((asm volatile("fence.acq_rel.gpu;\n\tst.relaxed.gpu.global.u64 [%0], %1;" ::"l"(
                                          _grid_sync.published + _league_rank),
                                      "l"(epoch)
                                      : "memory");))
    KOKKOS_IF_ON_HOST(((void)epoch;))
  }

  /// Waits until team `other` has ended `epoch`.
  KOKKOS_FUNCTION void await(int other, std::uint64_t epoch) const {
    KOKKOS_IF_ON_DEVICE((std::uint64_t seen; do {
      asm volatile("ld.acquire.gpu.global.u64 %0, [%1];"
                   : "=l"(seen)
                   : "l"(_grid_sync.published + other)
                   : "memory");
    } while (seen < epoch);))
    KOKKOS_IF_ON_HOST(((void)other; (void)epoch;))
  }

  /// Leaves three numbers of `epoch` at a place of the board. No order is kept with other memory: each number
  /// carries its epoch.
  KOKKOS_FUNCTION void put(std::uint64_t epoch, std::size_t place, const HaloValue& numbers) const {
    for (std::size_t k = 0; k < 3; ++k) store(row(epoch, k) + place, numbers.value[k], epoch);
  }

  /// The numbers at a place of the board, once those of `epoch` are there. Two boards are enough where who
  /// posts the next epoch but one has heard that this one is read: from all (`await_largest`), or from all
  /// who read its places.
  [[nodiscard]] KOKKOS_FUNCTION HaloValue get(std::uint64_t epoch, std::size_t place) const {
    HaloValue numbers{};
    KOKKOS_IF_ON_DEVICE((bool all = false; while (!all) {
      all = true;
      // Without a branch, so that the loads are in flight together.
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint64_t value, of;
        asm volatile("ld.relaxed.gpu.global.v2.u64 {%0, %1}, [%2];"
                     : "=l"(value), "=l"(of)
                     : "l"(row(epoch, k) + place));
        all = all && of == epoch;
        numbers.value[k] = Kokkos::bit_cast<double>(value);
      }
    }))
    KOKKOS_IF_ON_HOST(((void)epoch; (void)place;))
    return numbers;
  }

  /// Tells all teams `value`; one thread calls it. No order is kept with other memory.
  KOKKOS_FUNCTION void send(std::uint64_t epoch, std::uint64_t value) const {
    store(mailbox(epoch) + _league_rank, Kokkos::bit_cast<double>(value), epoch);
  }

  /// The largest value that teams tell for `epoch`, once all have. A whole warp calls it, all lanes get it.
  /// Two mailboxes are enough: who tells the next epoch but one has heard from all that they have read this
  /// one.
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t await_largest(std::uint64_t epoch) const {
    std::uint64_t largest = 0;
    KOKKOS_IF_ON_DEVICE((const HaloMessage* box = mailbox(epoch); bool all = false; while (!all) {
      all = true;
      largest = 0;
      // Without a branch, so that the loads are in flight together; lanes beyond the last team ask it again.
      for (int k = 0; k < most_teams; k += 32) {
        const HaloMessage* from = box + minimum(k + _team_rank % 32, _league_size - 1);
        std::uint64_t value, of;
        asm volatile("ld.relaxed.gpu.global.v2.u64 {%0, %1}, [%2];" : "=l"(value), "=l"(of) : "l"(from));
        all = all && of == epoch;
        largest = value > largest ? value : largest;
      }
      all = __all_sync(~0U, all);
    } largest = warp_maximum(~0U, largest);))
    KOKKOS_IF_ON_HOST(((void)epoch;))
    return largest;
  }

 private:
  KOKKOS_FUNCTION static void store(HaloMessage* to, double value, std::uint64_t epoch) {
    KOKKOS_IF_ON_DEVICE((asm volatile("st.relaxed.gpu.global.v2.u64 [%0], {%1, %2};" ::"l"(to),
                                      "l"(Kokkos::bit_cast<std::uint64_t>(value)), "l"(epoch)
                                      : "memory");))
    KOKKOS_IF_ON_HOST(((void)to; (void)value; (void)epoch;))
  }
  [[nodiscard]] KOKKOS_FUNCTION HaloMessage* row(std::uint64_t epoch, std::size_t k) const {
    return _grid_sync.board + (epoch % 2 * 3 + k) * _grid_sync.places;
  }
  [[nodiscard]] KOKKOS_FUNCTION HaloMessage* mailbox(std::uint64_t epoch) const {
    return _grid_sync.packets + (epoch % 2) * static_cast<std::uint64_t>(_league_size);
  }

  GridSync _grid_sync;
  int _team_rank, _team_size, _league_rank, _league_size;
  mutable std::size_t _used = 0;  ///< bytes of scratch memory
};

template <int most_threads, int least_teams, class Functor>
__global__ void __launch_bounds__(most_threads, least_teams)
    persistent_kernel(const __grid_constant__ Functor functor, GridSync grid_sync) {
  functor(PersistentMember(grid_sync, static_cast<int>(threadIdx.x), static_cast<int>(blockDim.x),
                           static_cast<int>(blockIdx.x), static_cast<int>(gridDim.x)));
}

template <>
class PersistentKernel<Kokkos::Cuda> {
 public:
  static constexpr bool available = true;

  /// One on each multiprocessor, as far as a warp can listen to them; none where the driver has no such
  /// launch.
  static int most_teams(const Instance<Kokkos::Cuda>& instance) {
    const cudaDeviceProp& device = instance.space().cuda_device_prop();
    return device.cooperativeLaunch != 0 ? std::min(device.multiProcessorCount, PersistentMember::most_teams)
                                         : 0;
  }
  static std::size_t most_scratch_bytes(const Instance<Kokkos::Cuda>& instance) {
    return instance.space().cuda_device_prop().sharedMemPerBlockOptin;
  }

  /// `teams` of `team_size` threads, each with `scratch_bytes` of shared memory, and a board of `places`.
  PersistentKernel(const Instance<Kokkos::Cuda>& instance, int teams, int team_size,
                   std::size_t scratch_bytes, std::size_t places)
      : _stream(instance.stream()),
        _teams(teams),
        _team_size(team_size),
        _scratch_bytes(static_cast<int>(scratch_bytes)),
        _published("drogue::device::published", static_cast<std::size_t>(teams)),
        _packets("drogue::device::packets", static_cast<std::size_t>(2 * teams)),
        _board("drogue::device::board", 2 * 3 * places),
        _places(places) {}

  /// Runs `functor(member)` in every thread, without waiting for its end. Throws std::runtime_error if the
  /// teams cannot all run at once.
  template <int most_threads, int least_teams, class Functor>
  void launch(const Functor& functor) const {
    const auto kernel = persistent_kernel<most_threads, least_teams, Functor>;
    GridSync grid_sync{_published.data(), _packets.data(), _board.data(), _places};
    void* arguments[] = {const_cast<Functor*>(&functor), &grid_sync};
    KOKKOS_IMPL_CUDA_SAFE_CALL(
        cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, _scratch_bytes));
    count_launch();
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaLaunchCooperativeKernel(
        reinterpret_cast<const void*>(kernel), dim3(static_cast<unsigned>(_teams)),
        dim3(static_cast<unsigned>(_team_size)), arguments, static_cast<std::size_t>(_scratch_bytes),
        _stream));
  }

 private:
  cudaStream_t _stream;
  int _teams, _team_size, _scratch_bytes;
  Kokkos::View<std::uint64_t*, Kokkos::CudaSpace> _published;
  Kokkos::View<HaloMessage*, Kokkos::CudaSpace> _packets, _board;
  std::size_t _places;
};

#endif

}  // namespace drogue::device
