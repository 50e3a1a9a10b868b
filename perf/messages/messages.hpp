#pragma once

#include <array>
#include <memory>

#include "kernels/device/backend_list.hpp"
#include "kernels/linear/parallel/rank_group.hpp"
#include "kernels/linear/parallel/transport.hpp"

// Messages between ranks without the rest of a step.

namespace drogue::perf::messages {

/// Messages between the ranks of a group that share a periodic flow, from and to the memory of a backend, as
/// in its steps: in a captured graph where those are. Functions are collective and block, unless stated
/// otherwise, and throw std::runtime_error if communication fails.
class Messages {
 public:
  virtual ~Messages() = default;

  /// Everything that ranks exchange in a step of one projection by a direct solver, `count` times, with the
  /// kernels that pack and unpack. No message is beside a computation.
  virtual void run_steps(long count) = 0;
  /// Exchanges of one number, or of `exchanged()` numbers, with each of both neighbours of a ring.
  virtual void run_shortest(long count) = 0;
  virtual void run_exchanges(long count) = 0;

  /// Numbers that this rank sends in a step, and those that it sends to both neighbours in an exchange:
  /// equally many. Do not block.
  [[nodiscard]] virtual double sent_in_step() const = 0;
  [[nodiscard]] virtual double exchanged() const = 0;
  /// Division of the axes, and how messages travel. Do not block.
  [[nodiscard]] virtual std::array<int, 3> parts() const = 0;
  [[nodiscard]] virtual linear::Transport transport() const = 0;

  /// Largest number of values on a rank that `run_steps` brought and that are not those of their sender.
  [[nodiscard]] virtual double wrong_values() = 0;
};

/// Messages for a flow of the given cells. Throws std::invalid_argument, with one sentence, if the ranks
/// cannot share it.
[[nodiscard]] std::unique_ptr<Messages> create_messages(device::Backend backend,
                                                        const std::array<int, 3>& cells,
                                                        const linear::RankGroup& group);

}  // namespace drogue::perf::messages
