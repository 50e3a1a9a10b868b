#include "kernels/device/ceilings.hpp"

namespace drogue::device {

// Defined in ceilings_on.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<CeilingKernel> make_ceiling(Ceiling ceiling);

std::unique_ptr<CeilingKernel> create_ceiling(Backend backend, Ceiling ceiling) {
  return dispatch(backend, [&]<class ExecutionSpace>() { return make_ceiling<ExecutionSpace>(ceiling); });
}

}  // namespace drogue::device
