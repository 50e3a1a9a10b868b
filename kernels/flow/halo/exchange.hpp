#pragma once

#include <cstdint>
#include <span>
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

/// Copies the numbers of boxes of an array to contiguous buffers, or back.
struct BoxCopyFunctor {
  static constexpr int most = 8;  ///< one for each neighbour among ranks that divide y and z
  int boxes = 0;
  Kokkos::Array<ArrayBox, most> box{};
  Kokkos::Array<double*, most> buffer{};
  bool to_buffers;
  double* array = nullptr;

  void add(const ArrayBox& added, double* its_buffer) {
    box[boxes] = added;
    buffer[boxes++] = its_buffer;
  }
  [[nodiscard]] int size() const {
    int sum = 0;
    for (int b = 0; b < boxes; ++b) sum += box[b].size();
    return sum;
  }

  KOKKOS_FUNCTION void operator()(int entry) const {
    int b = 0;
    while (entry >= box[b].size()) entry -= box[b++].size();
    const ArrayBox& own = box[b];
    const int i = entry % own.extent[0], rows = entry / own.extent[0];
    const int j = rows % own.extent[1], planes = rows / own.extent[1];
    const int k = planes % own.extent[2], c = planes / own.extent[2];
    const std::int64_t place =
        own.first + i * own.stride[0] + j * own.stride[1] + k * own.stride[2] + c * own.component;
    if (to_buffers)
      buffer[b][entry] = array[place];
    else
      array[place] = buffer[b][entry];
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
    _pack.add(box, buffer.data());
    _messages.push_back({.peer = peer,
                         .send_tag = tag,
                         .receive_tag = 0,
                         .send = {buffer.data(), buffer.size()},
                         .receive = {}});
  }
  /// Adds a message from `peer`, as `add_send`; `box` is its place in the array.
  void add_receive(int peer, int tag, const ArrayBox& box) {
    _unpack.add(box, add_receive(peer, tag, box.size()));
  }
  /// Adds a message of `size` numbers from `peer` that stays in a buffer. Returns the buffer, which lives as
  /// long as this object.
  double* add_receive(int peer, int tag, int size) {
    const Buffer buffer = make_buffer(size);
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
    copy(space, _pack, array);
    if (has_messages()) communicator.begin(space, _messages);
  }

  /// Completes what `begin` began, and fills `array` from the messages.
  void finish(const ExecutionSpace& space, const Communicator& communicator, double* array) const {
    if (has_messages()) communicator.finish(space);
    copy(space, _unpack, array);
  }

  /// Sends and receives all messages, and replaces the values, if any, by their maxima over the ranks.
  void run(const ExecutionSpace& space, const Communicator& communicator, double* array,
           std::span<std::uint64_t> maximized = {}) const {
    copy(space, _pack, array);
    if (!maximized.empty())
      communicator.maximize(space, maximized, _messages);
    else if (has_messages())
      communicator.exchange(space, _messages);
    copy(space, _unpack, array);
  }

 private:
  using Buffer = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  Buffer make_buffer(int size) {
    return _buffers.emplace_back("drogue::flow::message", static_cast<std::size_t>(size));
  }
  static void copy(const ExecutionSpace& space, BoxCopyFunctor functor, double* array) {
    if (functor.boxes == 0) return;
    functor.array = array;
    device::launch_each(space, functor.to_buffers ? "drogue::flow::pack" : "drogue::flow::unpack",
                        functor.size(), functor);
  }

  std::vector<Buffer> _buffers;
  BoxCopyFunctor _pack{.to_buffers = true}, _unpack{.to_buffers = false};
  std::vector<linear::Message> _messages;
};

}  // namespace drogue::flow
