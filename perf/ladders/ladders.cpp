#include <stdexcept>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

// Defined in the headers NAME/ladder.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
Ladder make_weno(bool small);
template <class ExecutionSpace>
Ladder make_springs(bool small);
template <class ExecutionSpace>
Ladder make_options(bool small);
template <class ExecutionSpace>
Ladder make_transfers(bool small);

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = {"weno", "springs", "options", "transfers"};
  return all;
}

Ladder create_ladder(const std::string& name, device::Backend backend, bool small) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() {
    if (name == "weno") return make_weno<ExecutionSpace>(small);
    if (name == "springs") return make_springs<ExecutionSpace>(small);
    if (name == "options") return make_options<ExecutionSpace>(small);
    if (name == "transfers") return make_transfers<ExecutionSpace>(small);
    throw std::invalid_argument("there is no ladder '" + name + "'");
  });
}

}  // namespace drogue::perf::ladder
