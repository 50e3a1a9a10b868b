#include "perf/pressure/pressure_impl.hpp"

namespace drogue::perf::pressure {

template bool supports<DROGUE_INSTANCE_SPACE>(const linear::PoissonProblem&, flow::PressureSolver);
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const linear::PoissonProblem&,
                                                                    flow::PressureSolver, double);

}  // namespace drogue::perf::pressure
