#include "kernels/options/cos_bermudan.hpp"

#include <stdexcept>

namespace drogue::options {

#define DROGUE_DECLARE(backend) std::unique_ptr<BermudanSolver> create_bermudan_solver_##backend();
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

std::unique_ptr<BermudanSolver> create_bermudan_solver(device::Backend backend) {
  switch (backend) {
#define DROGUE_CREATE(name)   \
  case device::Backend::name: \
    return create_bermudan_solver_##name();
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("cos: this build lacks the backend");
  }
}

}  // namespace drogue::options
