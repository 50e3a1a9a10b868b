#include "kernels/linear/parallel/nccl_communicator.hpp"

#if defined(DROGUE_HAVE_NCCL)

#include <cuda_runtime.h>
#include <nccl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace drogue::linear {

namespace {

void check(ncclResult_t result) {
  if (result == ncclSuccess) return;
  throw std::runtime_error(std::string("NCCL: ") + ncclGetErrorString(result) + ": " +
                           ncclGetLastError(nullptr));
}

void check(cudaError_t error) {
  if (error == cudaSuccess) return;
  throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(error));
}

/// Identifier of a new communicator, the same on all ranks.
ncclUniqueId shared_id(const RankGroup& group) {
  constexpr std::size_t numbers = sizeof(ncclUniqueId) / sizeof(double);
  static_assert(numbers * sizeof(double) == sizeof(ncclUniqueId));
  ncclUniqueId id{};
  if (group.rank() == 0) check(ncclGetUniqueId(&id));
  std::array<double, numbers> mine{};
  std::memcpy(mine.data(), &id, sizeof id);
  const std::vector<double> all = group.gather(mine);
  std::memcpy(&id, all.data(), sizeof id);
  return id;
}

}  // namespace

struct NcclCommunicator::Handles {
  ncclComm_t communicator = nullptr;
  cudaStream_t beside = nullptr;
  cudaEvent_t begun = nullptr, finished = nullptr;

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    if (beside != nullptr) cudaStreamSynchronize(beside);
    if (communicator != nullptr) ncclCommDestroy(communicator);
    if (begun != nullptr) cudaEventDestroy(begun);
    if (finished != nullptr) cudaEventDestroy(finished);
    if (beside != nullptr) cudaStreamDestroy(beside);
  }
};

NcclCommunicator::NcclCommunicator(const RankGroup& group) : _handles(std::make_unique<Handles>()) {
  // Multicast of NVLink serves large reductions alone, and takes memory and time to set up.
  setenv("NCCL_NVLS_ENABLE", "0", 0);
  int lowest = 0, highest = 0;
  check(cudaDeviceGetStreamPriorityRange(&lowest, &highest));
  // Messages begin while a kernel occupies the GPU.
  check(cudaStreamCreateWithPriority(&_handles->beside, cudaStreamNonBlocking, highest));
  check(cudaEventCreateWithFlags(&_handles->begun, cudaEventDisableTiming));
  check(cudaEventCreateWithFlags(&_handles->finished, cudaEventDisableTiming));
  check(ncclCommInitRank(&_handles->communicator, group.size(), shared_id(group), group.rank()));
}

NcclCommunicator::~NcclCommunicator() = default;

void NcclCommunicator::exchange(Stream stream, std::span<const Message> messages) const {
  // NCCL has no tags: what two ranks send each other, they must enqueue in one order.
  std::vector<Message> sent, received;
  for (const Message& message : messages) {
    if (!message.send.empty()) sent.push_back(message);
    if (!message.receive.empty()) received.push_back(message);
  }
  std::ranges::sort(sent, {}, [](const Message& m) { return std::tuple(m.peer, m.send_tag); });
  std::ranges::sort(received, {}, [](const Message& m) { return std::tuple(m.peer, m.receive_tag); });
  const ncclComm_t communicator = _handles->communicator;
  check(ncclGroupStart());
  for (const Message& message : sent)
    check(
        ncclSend(message.send.data(), message.send.size(), ncclFloat64, message.peer, communicator, stream));
  for (const Message& message : received)
    check(ncclRecv(message.receive.data(), message.receive.size(), ncclFloat64, message.peer, communicator,
                   stream));
  check(ncclGroupEnd());
}

void NcclCommunicator::begin_exchange(Stream stream, std::span<const Message> messages) const {
  check(cudaEventRecord(_handles->begun, stream));
  check(cudaStreamWaitEvent(_handles->beside, _handles->begun, 0));
  exchange(_handles->beside, messages);
  check(cudaEventRecord(_handles->finished, _handles->beside));
}

void NcclCommunicator::finish_exchange(Stream stream) const {
  check(cudaStreamWaitEvent(stream, _handles->finished, 0));
}

void NcclCommunicator::gather(Stream stream, const double* mine, double* all, std::size_t count) const {
  check(ncclAllGather(mine, all, count, ncclFloat64, _handles->communicator, stream));
}

void NcclCommunicator::maximize(Stream stream, std::span<std::uint64_t> values,
                                std::span<const Message> messages) const {
  check(ncclGroupStart());
  check(ncclAllReduce(values.data(), values.data(), values.size(), ncclUint64, ncclMax,
                      _handles->communicator, stream));
  exchange(stream, messages);
  check(ncclGroupEnd());
}

}  // namespace drogue::linear

#endif
