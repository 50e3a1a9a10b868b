#include "kernels/options/cos/bermudan.hpp"

namespace drogue::options {

// Defined in bermudan_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<BermudanSolver> make_bermudan_solver(int block);

std::unique_ptr<BermudanSolver> create_bermudan_solver(device::Backend backend, int block) {
  return device::dispatch(
      backend, [&]<class ExecutionSpace>() { return make_bermudan_solver<ExecutionSpace>(block); });
}

}  // namespace drogue::options
