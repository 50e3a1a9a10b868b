#include "kernels/coupling/sheet/coupled_solver.hpp"
#include "kernels/device/own_instance.hpp"
#include "kernels/flow/host_threads.hpp"

namespace drogue::coupling {

template class CoupledSolver<DROGUE_INSTANCE_SPACE>;

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& p, const linear::RankGroup& group) {
  return std::make_unique<device::OnOwnInstance<ExecutionSpace, CoupledSolver<ExecutionSpace>>>(
      flow::host_threads<ExecutionSpace>(p.flow, group), p, group);
}

template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&,
                                                                    const linear::RankGroup&);

}  // namespace drogue::coupling
