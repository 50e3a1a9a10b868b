#pragma once

#include <cstdint>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/linear/device_communicator.hpp"

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

/// Exchange of parts of an array with other ranks, through buffers in the memory of the array; without
/// messages, its functions do nothing. They are asynchronous as `linear::DeviceCommunicator` is.
template <class ExecutionSpace>
class Exchange {
 public:
  using Communicator = linear::DeviceCommunicator<ExecutionSpace>;

  /// Adds a message to `peer`. Messages between two ranks have different tags. Throws std::runtime_error if
  /// memory runs out.
  void add_send(int peer, int tag, const ArrayBox& box) {
    const Buffer buffer = make_buffer(box.size());
    _sent.push_back({box, buffer});
    _messages.push_back({.peer = peer,
                         .send_tag = tag,
                         .receive_tag = 0,
                         .send = {buffer.data(), buffer.size()},
                         .receive = {}});
  }
  /// Adds a message from `peer`, as `add_send`; `box` is its place in the array.
  void add_receive(int peer, int tag, const ArrayBox& box) {
    static_cast<void>(add_receive(peer, tag, box.size()));
    _received.back().box = box;
  }
  /// Adds a message of `size` numbers from `peer` that stays in a buffer. Returns the buffer, which lives as
  /// long as this object.
  const double* add_receive(int peer, int tag, int size) {
    const Buffer buffer = make_buffer(size);
    _received.push_back({ArrayBox{}, buffer});
    _messages.push_back({.peer = peer,
                         .send_tag = 0,
                         .receive_tag = tag,
                         .send = {},
                         .receive = {buffer.data(), buffer.size()}});
    return buffer.data();
  }

  /// False without messages. Does not throw.
  [[nodiscard]] bool has_messages() const { return !_messages.empty(); }

  /// Begins to send and receive all messages, from `array`.
  void begin(const ExecutionSpace& space, const Communicator& communicator, double* array) const {
    pack(space, array);
    if (has_messages()) communicator.begin(space, _messages);
  }

  /// Completes what `begin` began, and fills `array` from the messages.
  void finish(const ExecutionSpace& space, const Communicator& communicator, double* array) const {
    if (has_messages()) communicator.finish(space);
    unpack(space, array);
  }

  /// Sends and receives all messages.
  void run(const ExecutionSpace& space, const Communicator& communicator, double* array) const {
    pack(space, array);
    if (has_messages()) communicator.exchange(space, _messages);
    unpack(space, array);
  }

 private:
  using Buffer = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  struct Port {
    ArrayBox box;
    Buffer buffer;
  };

  static Buffer make_buffer(int size) {
    return Buffer("drogue::flow::message", static_cast<std::size_t>(size));
  }
  void pack(const ExecutionSpace& space, double* array) const {
    for (const Port& port : _sent) copy(space, port, array, true);
  }
  void unpack(const ExecutionSpace& space, double* array) const {
    for (const Port& port : _received)
      if (port.box.size() > 0) copy(space, port, array, false);
  }
  static void copy(const ExecutionSpace& space, const Port& port, double* array, bool to_buffer) {
    device::launch_each(space, to_buffer ? "drogue::flow::pack" : "drogue::flow::unpack", port.box.size(),
                        BoxCopyFunctor{port.box, to_buffer, array, port.buffer.data()});
  }

  std::vector<Port> _sent, _received;
  std::vector<linear::Message> _messages;
};

}  // namespace drogue::flow
