#include "perf/ladders/options/ladder.hpp"

namespace drogue::perf::ladder {

template Ladder make_options<DROGUE_INSTANCE_SPACE>(bool);

}  // namespace drogue::perf::ladder
