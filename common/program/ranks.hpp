#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace drogue {

/// The processes that a launcher started as one program. There is MPI for the life of the object if they are
/// several; a process alone starts nothing.
///
/// Whoever waits here sleeps between two looks: a rank that waits takes no core from one that computes. The
/// functions may be called from one thread at a time.
class Ranks {
 public:
  /// Throws Failure(usage) where the launcher is not that of the MPI which the program was built with.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] int rank() const { return _rank; }
  [[nodiscard]] int count() const { return _count; }
  [[nodiscard]] bool is_first() const { return _rank == 0; }
  /// How many of them share this rank's host, itself included.
  [[nodiscard]] int of_host() const { return _of_host; }

  /// Sends and does not wait until it has arrived.
  void send(int to, int tag, std::string bytes);

  /// Returns when all that was sent has left this rank.
  void wait_until_sent();

  /// The next message of that rank and tag, if all of it has come. Does not wait.
  [[nodiscard]] std::optional<std::string> receive(int from, int tag);

  /// Whether there is such a message, or has begun to come.
  [[nodiscard]] bool has_message(int from, int tag);

  /// The first rank's bytes, on every rank.
  [[nodiscard]] std::string from_first(std::string bytes);

  /// Runs `act` on every rank and returns when all have done it. If it throws on any of them, all throw the
  /// Failure of the lowest such rank: no rank goes on to wait for one that has given up.
  void together(const std::function<void()>& act);

 private:
  struct Transfer;
  void forget_sent();

  int _rank = 0;
  int _count = 1;
  int _of_host = 1;
  std::list<std::unique_ptr<Transfer>> _sendings;
  std::map<std::pair<int, int>, std::unique_ptr<Transfer>> _receivings;  ///< by rank and tag
};

/// Sleeps the longer the more often it is asked to since `reset`: 20 us to 1 ms.
class Pause {
 public:
  void wait();
  void reset() { _microseconds = least; }

 private:
  static constexpr int least = 20, most = 1000;
  int _microseconds = least;
};

}  // namespace drogue
