#include "perf/ceilings/ceilings_impl.hpp"

namespace drogue::perf {

template bool supports_ceiling<DROGUE_INSTANCE_SPACE>(Ceiling);
template std::unique_ptr<CeilingKernel> make_ceiling<DROGUE_INSTANCE_SPACE>(Ceiling);

}  // namespace drogue::perf
