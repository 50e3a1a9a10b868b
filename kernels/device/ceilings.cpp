#include "kernels/device/ceilings.hpp"

#include <Kokkos_Macros.hpp>
#include <stdexcept>

namespace drogue::device {

std::unique_ptr<CeilingKernel> create_ceiling_serial(Ceiling ceiling);
std::unique_ptr<CeilingKernel> create_ceiling_openmp(Ceiling ceiling);
std::unique_ptr<CeilingKernel> create_ceiling_cuda(Ceiling ceiling);

std::unique_ptr<CeilingKernel> create_ceiling(Backend backend, Ceiling ceiling) {
  switch (backend) {
    case Backend::serial:
      return create_ceiling_serial(ceiling);
#if defined(DROGUE_HAVE_OPENMP)
    case Backend::openmp:
      return create_ceiling_openmp(ceiling);
#endif
#if defined(KOKKOS_ENABLE_CUDA)
    case Backend::cuda:
      return create_ceiling_cuda(ceiling);
#endif
    default:
      throw std::invalid_argument("ceiling: this build lacks the backend");
  }
}

}  // namespace drogue::device
