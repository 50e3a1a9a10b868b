#include "perf/ladders/weno/ladder.hpp"

namespace drogue::perf::ladder {

template Ladder make_weno<DROGUE_INSTANCE_SPACE>(bool);

}  // namespace drogue::perf::ladder
