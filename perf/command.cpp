#include "perf/command.hpp"

namespace drogue::perf {

void require(device::Backend backend) {
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
}

}  // namespace drogue::perf
