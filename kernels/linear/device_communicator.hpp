#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/backend_list.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/parallel/nccl_communicator.hpp"
#include "kernels/linear/parallel/rank_group.hpp"
#include "kernels/linear/parallel/transport.hpp"

namespace drogue::linear {

/// Messages between the ranks of a group from and to memory of an execution space, enqueued on its instance.
/// Copies share the messages under way. That of a process alone does nothing.
///
/// Functions are collective, but for exchanges, which concern the two ends of each message. If the
/// communicator is asynchronous, they neither block nor allocate, and may be captured into a CUDA graph;
/// otherwise they block until the kernels before and the messages are complete. They throw
/// std::runtime_error if CUDA or NCCL fails; if MPI fails, it ends the program.
template <class ExecutionSpace>
class DeviceCommunicator {
 public:
  /// This process alone. Does not throw.
  DeviceCommunicator() = default;

  /// Chooses the transport: NCCL if this build has it and each rank has a GPU of its own, else MPI. The
  /// environment variable DROGUE_TRANSPORT of rank 0, with a name of `Transport`, enforces one. Collective;
  /// blocks. Throws std::invalid_argument if that one cannot be had, and std::runtime_error if NCCL fails.
  DeviceCommunicator(const ExecutionSpace& space, const RankGroup& group);

  [[nodiscard]] const RankGroup& group() const { return _group; }
  [[nodiscard]] int rank() const { return _group.rank(); }
  [[nodiscard]] int size() const { return _group.size(); }
  [[nodiscard]] Transport transport() const { return _transport; }
  /// True if functions only enqueue. Does not throw.
  [[nodiscard]] bool is_asynchronous() const {
    return _transport == Transport::nccl || _transport == Transport::none;
  }

  /// Sends and receives messages, numbers of any unit in memory of the space. Messages of a call from one
  /// rank to another have different tags.
  void exchange(const ExecutionSpace& space, std::span<const Message> messages) const;

  /// Begins an exchange, of which one at a time may be under way. Kernels enqueued until `finish` run
  /// beside it.
  void begin(const ExecutionSpace& space, std::span<const Message> messages) const;
  /// Completes the exchange of the last `begin`. The copy of received numbers to a device is enqueued.
  void finish(const ExecutionSpace& space) const;

  /// Gives all ranks the `count` numbers of each, of any unit, in the order of the ranks. `mine` may be
  /// their place in `all`.
  void gather(const ExecutionSpace& space, const double* mine, double* all, std::size_t count) const;

  /// Replaces each value, of any unit, by its maximum over the ranks, and sends and receives messages as
  /// `exchange` does: in one group of NCCL.
  void maximize(const ExecutionSpace& space, std::span<std::uint64_t> values,
                std::span<const Message> messages = {}) const;

 private:
  /// Number that a message brings to a device from page-locked memory.
  struct Arrival {
    std::span<double> place;
    const double* staged;
  };
  struct State {
    Transfers transfers;
    std::vector<Arrival> arrivals;
    Kokkos::View<double*, device::HostPinnedSpace<ExecutionSpace>> staging;
#if defined(DROGUE_HAVE_NCCL)
    std::unique_ptr<NcclCommunicator> nccl;
#endif
  };
  static constexpr bool on_host = device::is_host<ExecutionSpace>;

  static Transport choose(const ExecutionSpace& space, const RankGroup& group);
  static std::array<std::uint64_t, 2> device_identity(const ExecutionSpace& space);
  double* staging(const ExecutionSpace& space, std::size_t count) const;

  RankGroup _group;
  Transport _transport = Transport::none;
  std::shared_ptr<State> _state;  ///< null for a process alone
};

template <class ExecutionSpace>
DeviceCommunicator<ExecutionSpace>::DeviceCommunicator(const ExecutionSpace& space, const RankGroup& group)
    : _group(group) {
  if (group.size() == 1) return;
  _transport = choose(space, group);
  _state = std::make_shared<State>();
#if defined(DROGUE_HAVE_NCCL)
  if (_transport == Transport::nccl) _state->nccl = std::make_unique<NcclCommunicator>(group);
#endif
}

/// Identity of the GPU; zeros on a host.
template <class ExecutionSpace>
std::array<std::uint64_t, 2> DeviceCommunicator<ExecutionSpace>::device_identity(
    [[maybe_unused]] const ExecutionSpace& space) {
  std::array<std::uint64_t, 2> identity{};
#if defined(KOKKOS_ENABLE_CUDA)
  if constexpr (!on_host) {
    cudaDeviceProp properties;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaGetDeviceProperties(&properties, space.cuda_device()));
    static_assert(sizeof properties.uuid == sizeof identity);
    std::memcpy(identity.data(), &properties.uuid, sizeof identity);
  }
#elif defined(KOKKOS_ENABLE_HIP)
  if constexpr (!on_host) {
    hipUUID uuid;
    KOKKOS_IMPL_HIP_SAFE_CALL(hipDeviceGetUuid(&uuid, space.hip_device()));
    static_assert(sizeof uuid == sizeof identity);
    std::memcpy(identity.data(), &uuid, sizeof identity);
  }
#endif
  return identity;
}

template <class ExecutionSpace>
Transport DeviceCommunicator<ExecutionSpace>::choose(const ExecutionSpace& space, const RankGroup& group) {
  const char* const variable = std::getenv("DROGUE_TRANSPORT");
  const std::string_view wanted = variable != nullptr ? variable : "";
  std::size_t wanted_index = 0;
  while (wanted_index < transport_names.size() && transport_names[wanted_index] != wanted) ++wanted_index;
  const std::array<std::uint64_t, 2> identity = device_identity(space);
  const std::array<double, 4> mine = {std::bit_cast<double>(identity[0]), std::bit_cast<double>(identity[1]),
                                      static_cast<double>(wanted_index), wanted.empty() ? 0.0 : 1.0};
  const std::vector<double> all = group.gather(mine);
  bool shares_device = false;
  for (std::size_t a = 0; a < all.size(); a += mine.size())
    for (std::size_t b = 0; b < a; b += mine.size())
      shares_device = shares_device || std::memcmp(&all[a], &all[b], sizeof identity) == 0;
#if defined(DROGUE_HAVE_NCCL)
  constexpr bool has_nccl = true;
#else
  constexpr bool has_nccl = false;
#endif
  const bool can_nccl = !on_host && has_nccl && !shares_device,
             can_device_mpi = !on_host && mpi_takes_device_memory();
  if (all[3] == 0.0) {
    if (on_host) return Transport::mpi;
    if (can_nccl) return Transport::nccl;
    return can_device_mpi ? Transport::cuda_aware_mpi : Transport::host_staging;
  }
  const auto can = [&](Transport transport) {
    return (transport == Transport::nccl && can_nccl) ||
           (transport == Transport::cuda_aware_mpi && can_device_mpi) ||
           transport == Transport::host_staging || (transport == Transport::mpi && on_host);
  };
  const auto chosen = static_cast<Transport>(static_cast<int>(all[2]));
  if (static_cast<std::size_t>(all[2]) < transport_names.size() && can(chosen)) return chosen;
  std::string names;
  for (std::size_t t = 0; t < transport_names.size(); ++t)
    if (can(static_cast<Transport>(t)))
      names += (names.empty() ? "" : ", ") + std::string(transport_names[t]);
  throw std::invalid_argument("DROGUE_TRANSPORT: these ranks can exchange messages by " + names +
                              (shares_device && !on_host && has_nccl ? "; NCCL needs a GPU for each" : ""));
}

/// Page-locked memory for `count` numbers, whose former content may be lost.
template <class ExecutionSpace>
double* DeviceCommunicator<ExecutionSpace>::staging(const ExecutionSpace& space, std::size_t count) const {
  if (_state->staging.size() < count) {
    space.fence("drogue::linear::device_communicator: copied");
    _state->staging = decltype(_state->staging)(
        Kokkos::view_alloc(Kokkos::WithoutInitializing, "drogue::linear::staging"), count);
  }
  return _state->staging.data();
}

template <class ExecutionSpace>
void DeviceCommunicator<ExecutionSpace>::exchange(const ExecutionSpace& space,
                                                  std::span<const Message> messages) const {
  if (!_state) return;
#if defined(DROGUE_HAVE_NCCL)
  if constexpr (!on_host)
    if (_state->nccl) return _state->nccl->exchange(space.cuda_stream(), messages);
#endif
  begin(space, messages);
  finish(space);
}

template <class ExecutionSpace>
void DeviceCommunicator<ExecutionSpace>::begin(const ExecutionSpace& space,
                                               std::span<const Message> messages) const {
  if (!_state) return;
#if defined(DROGUE_HAVE_NCCL)
  if constexpr (!on_host)
    if (_state->nccl) return _state->nccl->begin_exchange(space.cuda_stream(), messages);
#endif
  std::vector<Message> sent(messages.begin(), messages.end());
  if (_transport == Transport::host_staging) {
    std::size_t count = 0;
    for (const Message& message : sent) count += message.send.size() + message.receive.size();
    double* staged = staging(space, count);
    for (Message& message : sent) {
      device::copy_bytes(space, device::CopyKind::to_host_pinned, staged, message.send.data(),
                         message.send.size_bytes());
      message.send = {staged, message.send.size()};
      staged += message.send.size();
      if (message.receive.empty()) continue;
      _state->arrivals.push_back({message.receive, staged});
      message.receive = {staged, message.receive.size()};
      staged += message.receive.size();
    }
  }
  // Also the kernels before, which may still read what will be received.
  space.fence("drogue::linear::device_communicator: to be sent");
  _state->transfers = _group.begin(sent);
}

template <class ExecutionSpace>
void DeviceCommunicator<ExecutionSpace>::finish(const ExecutionSpace& space) const {
  if (!_state) return;
#if defined(DROGUE_HAVE_NCCL)
  if constexpr (!on_host)
    if (_state->nccl) return _state->nccl->finish_exchange(space.cuda_stream());
#endif
  _state->transfers.wait();
  for (const Arrival& arrival : _state->arrivals)
    device::copy_bytes(space, device::CopyKind::to_device, arrival.place.data(), arrival.staged,
                       arrival.place.size_bytes());
  _state->arrivals.clear();
}

template <class ExecutionSpace>
void DeviceCommunicator<ExecutionSpace>::gather(const ExecutionSpace& space, const double* mine, double* all,
                                                std::size_t count) const {
  if (!_state) {
    if (all != mine) device::copy_bytes(space, device::CopyKind::within, all, mine, count * sizeof *mine);
    return;
  }
#if defined(DROGUE_HAVE_NCCL)
  if constexpr (!on_host)
    if (_state->nccl) return _state->nccl->gather(space.cuda_stream(), mine, all, count);
#endif
  const bool stages = _transport == Transport::host_staging;
  const std::size_t of_all = count * static_cast<std::size_t>(size());
  double* const staged = stages ? staging(space, of_all) : all;
  double* const own = staged + count * static_cast<std::size_t>(rank());
  if (stages) device::copy_bytes(space, device::CopyKind::to_host_pinned, own, mine, count * sizeof *mine);
  space.fence("drogue::linear::device_communicator: to be gathered");
  _group.gather(stages ? own : mine, staged, count);
  if (stages) device::copy_bytes(space, device::CopyKind::to_device, all, staged, of_all * sizeof *all);
}

template <class ExecutionSpace>
void DeviceCommunicator<ExecutionSpace>::maximize(const ExecutionSpace& space,
                                                  std::span<std::uint64_t> values,
                                                  std::span<const Message> messages) const {
  if (!_state) return;
#if defined(DROGUE_HAVE_NCCL)
  if constexpr (!on_host)
    if (_state->nccl) return _state->nccl->maximize(space.cuda_stream(), values, messages);
#endif
  if (!messages.empty()) exchange(space, messages);
  const bool stages = _transport == Transport::host_staging;
  auto* const staged = stages ? reinterpret_cast<std::uint64_t*>(staging(space, values.size()))
                              : values.data();  // NOLINT: of one size
  if (stages)
    device::copy_bytes(space, device::CopyKind::to_host_pinned, staged, values.data(), values.size_bytes());
  space.fence("drogue::linear::device_communicator: to be maximized");
  _group.maximize({staged, values.size()});
  if (stages)
    device::copy_bytes(space, device::CopyKind::to_device, values.data(), staged, values.size_bytes());
}

DROGUE_EXTERN_INSTANCES(class DeviceCommunicator)

}  // namespace drogue::linear
