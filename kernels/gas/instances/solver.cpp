#include "kernels/device/own_instance.hpp"
#include "kernels/gas/baseline/baseline_solver.hpp"

namespace drogue::gas {

template class GasSolver<DROGUE_INSTANCE_SPACE>;

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters) {
  return std::make_unique<device::OnOwnInstance<ExecutionSpace, GasSolver<ExecutionSpace>>>(
      host_threads(parameters), parameters);
}
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

template <class ExecutionSpace>
std::unique_ptr<Solver> make_baseline_solver(const Parameters& parameters) {
  return std::make_unique<BaselineSolver<ExecutionSpace>>(parameters);
}
template std::unique_ptr<Solver> make_baseline_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::gas
