#include "perf/ladders/machine.hpp"

namespace drogue::perf::ladder {

template Ceilings make_ceilings<DROGUE_INSTANCE_SPACE>();

}  // namespace drogue::perf::ladder
