#include "kernels/linear/positive.hpp"

#include <stdexcept>

namespace drogue::linear {

#define DROGUE_DECLARE(backend) \
  std::unique_ptr<BatchSolve> create_positive_solve_##backend(const PositiveSystems& systems);
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

std::unique_ptr<BatchSolve> create_positive_solve(device::Backend backend, const PositiveSystems& systems) {
  const auto batch = static_cast<std::size_t>(systems.batch), n = static_cast<std::size_t>(systems.unknowns);
  if (systems.batch < 1 || systems.unknowns < 1 || systems.diagonal.size() != batch * n ||
      systems.beside.size() != batch * (n - 1) || systems.right.size() != batch * n)
    throw std::invalid_argument("positive systems: the arrays are not those of so many unknowns");
  switch (backend) {
#define DROGUE_CREATE(name)   \
  case device::Backend::name: \
    return create_positive_solve_##name(systems);
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("positive systems: this build lacks the backend");
  }
}

}  // namespace drogue::linear
