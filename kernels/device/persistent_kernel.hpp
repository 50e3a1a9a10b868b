#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/device/instance.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/device/team_maximum.hpp"

namespace drogue::device {

/// Cooperative launch, which Kokkos lacks: all teams of the grid run concurrently, so that one kernel can
/// take many steps and synchronise its teams. Only available on CUDA.
template <class ExecutionSpace>
class PersistentKernel {
 public:
  static constexpr bool available = false;
};

/// Value of one halo slot.
struct HaloValue {
  double value[3];
};

#if defined(KOKKOS_ENABLE_CUDA)

/// Number with the epoch that it belongs to. All GPUs since Volta read and write 16 aligned bytes atomically,
/// although PTX guarantees it only for its newer 128-bit type.
struct alignas(16) HaloMessage {
  std::uint64_t value, epoch;
};

/// Memory through which the teams of a persistent kernel synchronise. Epochs increase over all launches, so
/// that no launch has to clear it.
struct GridSync {
  std::uint64_t* published;  ///< (teams): last epoch that each team has completed
  HaloMessage* mailboxes;    ///< (2, teams): values sent to all teams, for even and odd epochs
  HaloMessage* halo;         ///< (2, 3, halo_slots): values for neighbours, for even and odd epochs
  std::size_t halo_slots;
};

/// Team member with the interface of a Kokkos team member and with synchronisation of teams. It never runs on
/// the host, where its functions do nothing.
class PersistentMember {
 public:
  /// Largest number of teams whose mailboxes one warp can poll.
  static constexpr int most_teams = 192;

  /// Member `team_rank` of team `league_rank`.
  KOKKOS_FUNCTION PersistentMember(GridSync grid_sync, int team_rank, int team_size, int league_rank,
                                   int league_size)
      : _grid_sync(grid_sync),
        _team_rank(team_rank),
        _team_size(team_size),
        _league_rank(league_rank),
        _league_size(league_size) {}

  /// Index of the thread in its team, team size, index of the team, and number of teams.
  [[nodiscard]] KOKKOS_FUNCTION int team_rank() const { return _team_rank; }
  [[nodiscard]] KOKKOS_FUNCTION int team_size() const { return _team_size; }
  [[nodiscard]] KOKKOS_FUNCTION int league_rank() const { return _league_rank; }
  [[nodiscard]] KOKKOS_FUNCTION int league_size() const { return _league_size; }

  /// Barrier of all threads of the team.
  KOKKOS_FUNCTION void team_barrier() const { KOKKOS_IF_ON_DEVICE((__syncthreads();)) }

  /// Scratch memory of the team. Unlike the handle of Kokkos, it lets the compiler see that this is shared
  /// memory.
  [[nodiscard]] KOKKOS_FUNCTION const PersistentMember& team_scratch(int) const { return *this; }

  /// Allocates `bytes` of scratch memory; `alignment` is in bytes.
  KOKKOS_FUNCTION void* get_shmem_aligned(std::size_t bytes, std::size_t alignment) const {
    void* allocated = nullptr;
    KOKKOS_IF_ON_DEVICE((extern __shared__ double persistent_scratch[];
                         _used = (_used + alignment - 1) / alignment * alignment;
                         allocated = reinterpret_cast<char*>(persistent_scratch) + _used;))
    KOKKOS_IF_ON_HOST(((void)alignment;))
    _used += bytes;
    return allocated;
  }

  /// Last epoch that this team, and so every team, had completed at the beginning of the launch.
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t epoch() const { return _grid_sync.published[_league_rank]; }

  /// Marks `epoch` as completed by this team. One thread calls it after a barrier. Teams that await the epoch
  /// see all earlier writes of this team.
  KOKKOS_FUNCTION void publish(std::uint64_t epoch) const {
    KOKKOS_IF_ON_DEVICE((asm volatile("fence.acq_rel.gpu;\n\tst.relaxed.gpu.global.u64 [%0], %1;" ::"l"(
                                          _grid_sync.published + _league_rank),
                                      "l"(epoch)
                                      : "memory");))
    KOKKOS_IF_ON_HOST(((void)epoch;))
  }

  /// Blocks until team `other` has completed `epoch`.
  KOKKOS_FUNCTION void await(int other, std::uint64_t epoch) const {
    KOKKOS_IF_ON_DEVICE((std::uint64_t seen; do {
      asm volatile("ld.acquire.gpu.global.u64 %0, [%1];"
                   : "=l"(seen)
                   : "l"(_grid_sync.published + other)
                   : "memory");
    } while (seen < epoch);))
    KOKKOS_IF_ON_HOST(((void)other; (void)epoch;))
  }

  /// Writes three numbers of `epoch` to a halo slot. Unordered with respect to other memory; each number
  /// carries its epoch.
  KOKKOS_FUNCTION void put(std::uint64_t epoch, std::size_t slot, const HaloValue& numbers) const {
    for (std::size_t k = 0; k < 3; ++k) store(row(epoch, k) + slot, numbers.value[k], epoch);
  }

  /// Numbers of `epoch` in a halo slot. Blocks until they are written. Double buffering suffices if a team
  /// writes epoch + 2 only after all readers of its slots, or all teams (`await_largest`), have finished
  /// epoch.
  [[nodiscard]] KOKKOS_FUNCTION HaloValue get(std::uint64_t epoch, std::size_t slot) const {
    HaloValue numbers{};
    KOKKOS_IF_ON_DEVICE((bool all = false; while (!all) {
      all = true;
      // Branch-free, so that the loads overlap.
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint64_t value, of;
        asm volatile("ld.relaxed.gpu.global.v2.u64 {%0, %1}, [%2];"
                     : "=l"(value), "=l"(of)
                     : "l"(row(epoch, k) + slot));
        all = all && of == epoch;
        numbers.value[k] = Kokkos::bit_cast<double>(value);
      }
    }))
    KOKKOS_IF_ON_HOST(((void)epoch; (void)slot;))
    return numbers;
  }

  /// Sends `value` of `epoch` to all teams. One thread calls it. Unordered with respect to other memory.
  KOKKOS_FUNCTION void send(std::uint64_t epoch, std::uint64_t value) const {
    store(mailbox(epoch) + _league_rank, Kokkos::bit_cast<double>(value), epoch);
  }

  /// Largest value that the teams send for `epoch`. Blocks until all teams have sent one. All lanes of a warp
  /// call it and get the result. Double buffering suffices: a team sends epoch + 2 only after all teams have
  /// read epoch.
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t await_largest(std::uint64_t epoch) const {
    std::uint64_t largest = 0;
    KOKKOS_IF_ON_DEVICE((const HaloMessage* box = mailbox(epoch); bool all = false; while (!all) {
      all = true;
      largest = 0;
      // Branch-free, so that the loads overlap; surplus lanes read the last team again.
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
    return _grid_sync.halo + (epoch % 2 * 3 + k) * _grid_sync.halo_slots;
  }
  [[nodiscard]] KOKKOS_FUNCTION HaloMessage* mailbox(std::uint64_t epoch) const {
    return _grid_sync.mailboxes + (epoch % 2) * static_cast<std::uint64_t>(_league_size);
  }

  GridSync _grid_sync;
  int _team_rank, _team_size, _league_rank, _league_size;
  mutable std::size_t _used = 0;  ///< bytes of scratch memory
};

/// Kernel of a cooperative launch: calls `functor(member)` in every thread. Does not throw.
template <int most_threads, int least_teams, class Functor>
__global__ void __launch_bounds__(most_threads, least_teams)
    persistent_kernel(const __grid_constant__ Functor functor, GridSync grid_sync) {
  functor(PersistentMember(grid_sync, static_cast<int>(threadIdx.x), static_cast<int>(blockDim.x),
                           static_cast<int>(blockIdx.x), static_cast<int>(gridDim.x)));
}

/// Cooperative launch on a stream.
template <>
class PersistentKernel<Kokkos::Cuda> {
 public:
  static constexpr bool available = true;

  /// Number of teams: one per multiprocessor, limited by `PersistentMember::most_teams`. 0 if the device does
  /// not support cooperative launches. Does not throw.
  static int most_teams(const Instance<Kokkos::Cuda>& instance) {
    const cudaDeviceProp& device = instance.space().cuda_device_prop();
    return device.cooperativeLaunch != 0 ? std::min(device.multiProcessorCount, PersistentMember::most_teams)
                                         : 0;
  }

  /// Largest scratch memory of a team, bytes. Does not throw.
  static std::size_t most_scratch_bytes(const Instance<Kokkos::Cuda>& instance) {
    return instance.space().cuda_device_prop().sharedMemPerBlockOptin;
  }

  /// Grid of `teams` teams of `team_size` threads, with `scratch_bytes` of shared memory per team and
  /// `halo_slots` slots for values of neighbours. Throws std::runtime_error if device memory is exhausted.
  PersistentKernel(const Instance<Kokkos::Cuda>& instance, int teams, int team_size,
                   std::size_t scratch_bytes, std::size_t halo_slots)
      : _stream(instance.stream()),
        _teams(teams),
        _team_size(team_size),
        _scratch_bytes(static_cast<int>(scratch_bytes)),
        _published("drogue::device::published", static_cast<std::size_t>(teams)),
        _mailboxes("drogue::device::mailboxes", static_cast<std::size_t>(2 * teams)),
        _halo("drogue::device::halo", 2 * 3 * halo_slots),
        _halo_slots(halo_slots) {}

  /// Calls `functor(member)` in every thread. Asynchronous. Throws std::runtime_error if the teams cannot all
  /// run concurrently.
  template <int most_threads, int least_teams, class Functor>
  void launch(const Functor& functor) const {
    const auto kernel = persistent_kernel<most_threads, least_teams, Functor>;
    GridSync grid_sync{_published.data(), _mailboxes.data(), _halo.data(), _halo_slots};
    void* arguments[] = {const_cast<Functor*>(&functor), &grid_sync};
    KOKKOS_IMPL_CUDA_SAFE_CALL(
        cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, _scratch_bytes));
    count_launch();
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaLaunchCooperativeKernel(
        reinterpret_cast<const void*>(kernel), dim3(static_cast<unsigned>(_teams)),
        dim3(static_cast<unsigned>(_team_size)), arguments, static_cast<std::size_t>(_scratch_bytes),
        _stream));
  }

  /// Clears all halo slots, so that epochs may restart at 1. Asynchronous. Throws std::runtime_error for a
  /// CUDA error.
  void clear_messages() const {
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaMemsetAsync(_halo.data(), 0, _halo.size() * sizeof(HaloMessage), _stream));
  }

 private:
  cudaStream_t _stream;
  int _teams, _team_size, _scratch_bytes;
  Kokkos::View<std::uint64_t*, Kokkos::CudaSpace> _published;
  Kokkos::View<HaloMessage*, Kokkos::CudaSpace> _mailboxes, _halo;
  std::size_t _halo_slots;
};

#endif

}  // namespace drogue::device
