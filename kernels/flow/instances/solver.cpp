#include "kernels/device/own_instance.hpp"
#include "kernels/flow/flow_solver.hpp"
#include "kernels/flow/host_threads.hpp"

namespace drogue::flow {

template class FlowSolver<DROGUE_INSTANCE_SPACE>;

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters, const linear::RankGroup& group) {
  return std::make_unique<device::OnOwnInstance<ExecutionSpace, FlowSolver<ExecutionSpace>>>(
      host_threads<ExecutionSpace>(parameters, group), parameters, group);
}
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&,
                                                                    const linear::RankGroup&);

}  // namespace drogue::flow
