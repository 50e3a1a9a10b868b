#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::flow {

/// Numbers of an array: a box of several components.
struct ArrayBox {
  std::int64_t first;      ///< offset of the first number
  std::int64_t stride[3];  ///< along the axes
  std::int64_t component;  ///< distance of components
  int extent[3];
  int components;

  [[nodiscard]] KOKKOS_FUNCTION int size() const { return extent[0] * extent[1] * extent[2] * components; }
};

/// Copies the numbers of a box to a contiguous buffer, or back.
struct BoxCopyFunctor {
  ArrayBox box;
  bool to_buffer;
  double *array, *buffer;

  KOKKOS_FUNCTION void operator()(const int entry) const {
    const int i = entry % box.extent[0], rows = entry / box.extent[0];
    const int j = rows % box.extent[1], planes = rows / box.extent[1];
    const int k = planes % box.extent[2], c = planes / box.extent[2];
    const std::int64_t place =
        box.first + i * box.stride[0] + j * box.stride[1] + k * box.stride[2] + c * box.component;
    if (to_buffer)
      buffer[entry] = array[place];
    else
      array[place] = buffer[entry];
  }
};

/// Exchange of parts of an array with other ranks; without messages, its functions do nothing. Buffers are in
/// host memory that the kernels access directly; MPI without support of devices suffices.
template <class ExecutionSpace>
class Exchange {
 public:
  using Buffer = Kokkos::View<double*, device::HostPinnedSpace<ExecutionSpace>>;

  /// Adds a message to `peer`. Messages between two ranks have different tags. Throws std::runtime_error if
  /// memory runs out.
  void add_send(int peer, int tag, const ArrayBox& box) { _sent.push_back(port(peer, tag, box)); }
  /// Adds a message from `peer`, as `add_send`; `box` is its place in the array.
  void add_receive(int peer, int tag, const ArrayBox& box) { _received.push_back(port(peer, tag, box)); }
  /// Adds a message of `size` numbers from `peer` that stays in a buffer, in host memory that kernels access.
  /// Returns the buffer, which lives as long as this object.
  const double* add_receive(int peer, int tag, int size) {
    const ArrayBox none{};
    _received.push_back({peer, tag, none, buffer(size)});
    return _received.back().buffer.data();
  }

  /// Begins to send and receive all messages, from `array`; false without messages. Blocks until the kernels
  /// before are complete.
  [[nodiscard]] linear::Transfers begin(const ExecutionSpace& space, const linear::RankGroup& group,
                                        double* array) const {
    if (_sent.empty() && _received.empty()) return {};
    std::vector<linear::Message> messages;
    for (const Port& port : _sent) {
      copy(space, port, array, true);
      messages.push_back({.peer = port.peer,
                          .send_tag = port.tag,
                          .receive_tag = 0,
                          .send = {port.buffer.data(), port.buffer.size()},
                          .receive = {}});
    }
    // Also the kernels before, which may still read the buffers of the last exchange.
    space.fence("drogue::flow::exchange: packed");
    for (const Port& port : _received)
      messages.push_back({.peer = port.peer,
                          .send_tag = 0,
                          .receive_tag = port.tag,
                          .send = {},
                          .receive = {port.buffer.data(), port.buffer.size()}});
    return group.begin(messages);
  }

  /// Blocks until the messages are complete, but not for the kernels that fill `array` from them.
  void finish(const ExecutionSpace& space, linear::Transfers& transfers, double* array) const {
    if (!transfers) return;
    transfers.wait();
    for (const Port& port : _received)
      if (port.box.size() > 0) copy(space, port, array, false);
  }

  /// Sends and receives all messages.
  void run(const ExecutionSpace& space, const linear::RankGroup& group, double* array) const {
    linear::Transfers transfers = begin(space, group, array);
    finish(space, transfers, array);
  }

 private:
  struct Port {
    int peer, tag;
    ArrayBox box;
    Buffer buffer;
  };

  static Port port(int peer, int tag, const ArrayBox& box) { return {peer, tag, box, buffer(box.size())}; }
  static Buffer buffer(int size) { return Buffer("drogue::flow::message", static_cast<std::size_t>(size)); }
  static void copy(const ExecutionSpace& space, const Port& port, double* array, bool to_buffer) {
    device::launch_each(space, to_buffer ? "drogue::flow::pack" : "drogue::flow::unpack", port.box.size(),
                        BoxCopyFunctor{port.box, to_buffer, array, port.buffer.data()});
  }

  std::vector<Port> _sent, _received;
};

}  // namespace drogue::flow
