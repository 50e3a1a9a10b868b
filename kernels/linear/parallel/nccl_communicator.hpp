#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "kernels/linear/parallel/rank_group.hpp"

#if defined(DROGUE_HAVE_NCCL)

struct CUstream_st;

namespace drogue::linear {

/// Communicator of NCCL for the ranks of a group, each with the GPU that is current at construction.
///
/// Functions are enqueued on a CUDA stream, which may be captured into a graph, and neither block nor
/// allocate. Pointers are to memory of the GPU. They throw std::runtime_error if NCCL or CUDA fails.
class NcclCommunicator {
 public:
  using Stream = CUstream_st*;

  /// Collective; blocks. No two ranks may have the same GPU.
  explicit NcclCommunicator(const RankGroup& group);
  ~NcclCommunicator();
  NcclCommunicator(const NcclCommunicator&) = delete;
  NcclCommunicator& operator=(const NcclCommunicator&) = delete;

  /// Sends and receives messages, those between two ranks in the order of their tags.
  void exchange(Stream stream, std::span<const Message> messages) const;
  /// The same on a stream of its own of the highest priority, after what is enqueued on `stream`.
  void begin_exchange(Stream stream, std::span<const Message> messages) const;
  /// Lets `stream` wait for the messages of `begin_exchange`.
  void finish_exchange(Stream stream) const;
  /// As `DeviceCommunicator::gather`.
  void gather(Stream stream, const double* mine, double* all, std::size_t count) const;
  /// As `DeviceCommunicator::maximize`.
  void maximize(Stream stream, std::span<std::uint64_t> values, std::span<const Message> messages) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> _handles;
};

}  // namespace drogue::linear

#endif
