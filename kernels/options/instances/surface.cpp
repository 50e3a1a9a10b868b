#include "kernels/options/surface/surface_impl.hpp"

namespace drogue::options {

template std::unique_ptr<Pricer> make_surface<DROGUE_INSTANCE_SPACE>(const Settings&,
                                                                     std::unique_ptr<Pricer>);

}  // namespace drogue::options
