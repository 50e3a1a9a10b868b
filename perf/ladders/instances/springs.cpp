#include "perf/ladders/springs/ladder.hpp"

namespace drogue::perf::ladder {

template Ladder make_springs<DROGUE_INSTANCE_SPACE>(bool);

}  // namespace drogue::perf::ladder
