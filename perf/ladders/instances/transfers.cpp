#include "perf/ladders/transfers/ladder.hpp"

namespace drogue::perf::ladder {

template Ladder make_transfers<DROGUE_INSTANCE_SPACE>(bool);

}  // namespace drogue::perf::ladder
