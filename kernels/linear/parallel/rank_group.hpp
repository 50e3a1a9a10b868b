#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace drogue::linear {

/// True if MPI takes memory of devices of this build (CUDA or HIP), by its own account. Needs an initialised
/// MPI. Does not throw.
[[nodiscard]] bool mpi_takes_device_memory();

/// Message to and from another rank: numbers of any unit, in host memory unless stated otherwise. `send` or
/// `receive` may be empty.
struct Message {
  int peer;
  int send_tag, receive_tag;
  std::span<const double> send;
  std::span<double> receive;
};

/// Messages under way. The destructor waits for them. Does not throw.
class Transfers {
 public:
  /// No messages. Does not throw.
  Transfers();
  ~Transfers();
  /// Takes over the messages of `other`.
  Transfers(Transfers&& other) noexcept;
  /// Waits for its own messages, then takes over those of `other`.
  Transfers& operator=(Transfers&& other) noexcept;

  /// Blocks until all messages are complete. Does not throw.
  void wait();

  /// True until `wait`. Does not throw.
  explicit operator bool() const { return _requests != nullptr; }

 private:
  friend class RankGroup;
  struct Requests;
  std::unique_ptr<Requests> _requests;
};

/// Group of MPI processes, or one process alone without MPI. Copies share the communicator.
///
/// Member functions are collective and block, unless stated otherwise. Numbers are in host memory, or in that
/// of a device if `mpi_takes_device_memory`. If communication fails, MPI ends the
/// program. Numbers may have any unit. One thread at a time may call them.
class RankGroup {
 public:
  /// This process alone. Does not throw.
  RankGroup();

  /// All processes of the program, with a communicator of its own. Initialises MPI, until the program ends,
  /// if that was not done. Throws std::runtime_error if MPI does not support threads that call it in turn.
  [[nodiscard]] static RankGroup world();

  /// Rank of this process in the group. Neither blocks nor throws.
  [[nodiscard]] int rank() const { return _rank; }
  /// Number of processes. Neither blocks nor throws.
  [[nodiscard]] int size() const { return _size; }
  /// Number of processes of the group on the host of this one, including itself. Neither blocks nor throws.
  [[nodiscard]] int ranks_on_host() const { return _ranks_on_host; }

  /// Group of the processes that give the same `color`, in the order of their ranks. Does not throw.
  [[nodiscard]] RankGroup split(int color) const;

  /// Replaces each value, of any unit, by its maximum over all ranks. Does not throw.
  void maximize(std::span<std::uint64_t> values) const;

  /// True if it is true on all ranks. Does not throw.
  [[nodiscard]] bool all(bool mine) const;

  /// Replaces each value, of any unit, by its sum over all ranks. Does not throw.
  void sum(std::span<double> values) const;

  /// Values of all ranks, in their unit and in the order of the ranks. Each rank gives equally many. Does not
  /// throw but std::bad_alloc.
  [[nodiscard]] std::vector<double> gather(std::span<const double> values) const;
  /// The same to `all`, of which `values`, `count` numbers, may be the part of this rank. Does not throw.
  void gather(const double* values, double* all, std::size_t count) const;

  /// Begins to send and receive the messages, numbers of any unit that must stay in place until they are
  /// complete. Both ends of a message must agree on its length; the tags of messages from one rank to another
  /// must differ. Not collective; does not block. Does not throw but std::bad_alloc.
  [[nodiscard]] Transfers begin(std::span<const Message> messages) const;

  /// Sends and receives the messages, numbers of any unit. Not collective: blocks until these messages are
  /// complete. Does not throw but std::bad_alloc.
  void exchange(std::span<const Message> messages) const { begin(messages).wait(); }

  /// Sends `send_counts[r]` numbers, of any unit, to each rank r and receives `receive_counts[r]` from it.
  /// The numbers stand in the order of the ranks, without gaps. Does not throw but std::bad_alloc.
  void redistribute(const double* send, const std::vector<int>& send_counts, double* receive,
                    const std::vector<int>& receive_counts) const;

  /// Communicator as a Fortran handle, which needs no header of MPI; that of this process alone initialises
  /// MPI as `world` does. Neither blocks nor throws.
  [[nodiscard]] int handle() const;

 private:
  struct Communicator;
  explicit RankGroup(std::shared_ptr<const Communicator> communicator);

  std::shared_ptr<const Communicator> _communicator;  ///< null for one process alone
  int _rank = 0, _size = 1, _ranks_on_host = 1;
};

}  // namespace drogue::linear
