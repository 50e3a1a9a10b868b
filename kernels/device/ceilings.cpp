#include "kernels/device/ceilings.hpp"

#include <stdexcept>

namespace drogue::device {

#define DROGUE_DECLARE(backend) std::unique_ptr<CeilingKernel> create_ceiling_##backend(Ceiling ceiling);
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

std::unique_ptr<CeilingKernel> create_ceiling(Backend backend, Ceiling ceiling) {
  switch (backend) {
#define DROGUE_CREATE(name) \
  case Backend::name:       \
    return create_ceiling_##name(ceiling);
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("ceiling: this build lacks the backend");
  }
}

}  // namespace drogue::device
