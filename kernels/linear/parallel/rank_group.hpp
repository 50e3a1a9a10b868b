#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace drogue::linear {

/// Message to and from another rank. `send` and `receive` are in host memory; one of them may be empty.
struct Message {
  int peer;
  int send_tag, receive_tag;
  std::span<const double> send;
  std::span<double> receive;
};

/// Messages under way. The destructor waits for them.
class Transfers {
 public:
  /// No messages. Does not throw.
  Transfers();
  ~Transfers();
  Transfers(Transfers&& other) noexcept;
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
/// Member functions are collective and block, unless stated otherwise. They end the program, as MPI does, if
/// communication fails. One thread at a time may call them.
class RankGroup {
 public:
  /// This process alone. Does not throw.
  RankGroup();

  /// All processes of the program, with a communicator of its own. Initialises MPI, until the program ends,
  /// if that was not done. Throws std::runtime_error if MPI does not support threads that call it in turn.
  [[nodiscard]] static RankGroup world();

  /// Rank of this process in the group. Does not block.
  [[nodiscard]] int rank() const { return _rank; }
  /// Number of processes. Does not block.
  [[nodiscard]] int size() const { return _size; }
  /// Number of processes of the group on the host of this one, including itself. Does not block.
  [[nodiscard]] int ranks_on_host() const { return _ranks_on_host; }

  /// Group of the processes that give the same `color`, in the order of their ranks.
  [[nodiscard]] RankGroup split(int color) const;

  /// Replaces each value by its maximum over all ranks.
  void maximize(std::span<std::uint64_t> values) const;

  /// Replaces each value by its sum over all ranks.
  void sum(std::span<double> values) const;

  /// Values of all ranks, in the order of the ranks. Each rank gives equally many.
  [[nodiscard]] std::vector<double> gather(std::span<const double> values) const;

  /// Begins to send and receive the messages, whose numbers must stay in place until they are complete. Both
  /// ends of a message must agree on its length; the tags of messages from one rank to another must differ. Not
  /// collective; does not block.
  [[nodiscard]] Transfers begin(std::span<const Message> messages) const;

  /// Sends and receives the messages. Not collective: blocks until these messages are complete.
  void exchange(std::span<const Message> messages) const { begin(messages).wait(); }

  /// Sends `send_counts[r]` numbers to each rank r and receives `receive_counts[r]` from it. The numbers stand
  /// in the order of the ranks, without gaps.
  void redistribute(const double* send, const std::vector<int>& send_counts, double* receive,
                    const std::vector<int>& receive_counts) const;

  /// Communicator as a Fortran handle, which needs no header of MPI; that of this process alone initialises
  /// MPI as `world` does. Does not block.
  [[nodiscard]] int handle() const;

 private:
  struct Communicator;
  explicit RankGroup(std::shared_ptr<const Communicator> communicator);

  std::shared_ptr<const Communicator> _communicator;  ///< null for one process alone
  int _rank = 0, _size = 1, _ranks_on_host = 1;
};

}  // namespace drogue::linear
