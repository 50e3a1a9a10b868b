#pragma once

#include <utility>

#include "kernels/device/instance.hpp"

namespace drogue::device {

/// Base that is constructed before a solver and destroyed after it.
template <class ExecutionSpace>
struct InstanceHolder {
  Instance<ExecutionSpace> instance;
};

/// `Solver` on an execution-space instance of its own. Its constructor takes that instance first.
template <class ExecutionSpace, class Solver>
class OnOwnInstance final : private InstanceHolder<ExecutionSpace>, public Solver {
 public:
  /// `threads`: as for the constructor of `Instance`. Throws as that one and the constructor of `Solver` do.
  template <class... Arguments>
  explicit OnOwnInstance(int threads, const Arguments&... arguments)
      : InstanceHolder<ExecutionSpace>{Instance<ExecutionSpace>(threads)},
        Solver(std::as_const(this->instance), arguments...) {}
};

}  // namespace drogue::device
