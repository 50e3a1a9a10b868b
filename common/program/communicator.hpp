#pragma once

#include <cstring>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace drogue {

/// Communicator of all processes that a launcher started as one program. MPI is initialized for the life of
/// the object if there are several; a single process starts nothing.
///
/// Blocking functions sleep between two polls, so that a waiting rank takes no core from a computing one. One
/// thread at a time may call the functions.
class Communicator {
 public:
  /// Collective. Throws `Failure` (usage) if the launcher does not belong to the MPI of this build.
  Communicator();
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  /// This process alone, however many a launcher started. Does not throw.
  [[nodiscard]] static Communicator& self();

  [[nodiscard]] int rank() const { return _rank; }
  [[nodiscard]] int size() const { return _size; }
  [[nodiscard]] bool is_root() const { return _rank == 0; }
  /// Number of ranks on the host of this rank, including itself.
  [[nodiscard]] int ranks_on_host() const { return _ranks_on_host; }

  /// Sends a message. Asynchronous.
  void send(int to, int tag, std::string bytes);

  /// Blocks until all sent messages have left this rank.
  void wait_until_sent();

  /// Next message of that rank and tag, if it has arrived completely. Does not block.
  [[nodiscard]] std::optional<std::string> receive(int from, int tag);

  /// True if a message of that rank and tag has begun to arrive. Does not block.
  [[nodiscard]] bool has_message(int from, int tag);

  /// Returns the bytes of rank 0 on every rank. Collective and blocking.
  [[nodiscard]] std::string broadcast(std::string bytes);

  /// Returns the value of rank 0 on every rank. Collective and blocking.
  template <class Value>
  [[nodiscard]] Value broadcast(Value value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const std::string bytes = broadcast(std::string(reinterpret_cast<const char*>(&value), sizeof value));
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

  /// Runs `action`, which must not communicate, on every rank. Collective; blocks until all ranks are done.
  /// If it throws on some ranks, all ranks throw the `Failure` of the lowest one, so that no rank waits for
  /// one that has given up.
  void run_collectively(const std::function<void()>& action);

  /// Runs `action` on rank 0. Collective; blocks until it is done. All ranks throw the `Failure` of rank 0.
  void run_on_root(const std::function<void()>& action);

  /// Runs an action in which ranks communicate. An exception other than a `Failure`, which all ranks throw
  /// alike, ends all ranks (`abort`), because the others wait for this one: after `before_abort`, if it is
  /// that of rank 0. A process alone throws it.
  void run_or_abort(const std::function<void()>& action, const std::function<void()>& before_abort = {});

  /// Prints the exception that is being handled and ends all ranks with its exit code, where other ranks wait
  /// for this one. Call it in a catch block only.
  [[noreturn]] void abort();

 private:
  struct Transfer;
  struct Alone {};
  explicit Communicator(Alone);
  void release_sent();

  int _rank = 0;
  int _size = 1;
  int _ranks_on_host = 1;
  std::list<std::unique_ptr<Transfer>> _sends;
  std::map<std::pair<int, int>, std::unique_ptr<Transfer>> _receives;  ///< by rank and tag
};

/// Sleeps for a time that doubles with every call since `reset`, from 20 us to 1 ms.
class Backoff {
 public:
  void wait();
  void reset() { _microseconds = least; }

 private:
  static constexpr int least = 20, most = 1000;
  int _microseconds = least;
};

}  // namespace drogue
