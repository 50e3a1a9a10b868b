#include "kernels/fabric/contact/contact_impl.hpp"

namespace drogue::fabric {

template std::unique_ptr<ContactHandler<DROGUE_INSTANCE_SPACE>> make_contact(
    const Mesh&, const Contact&, Driver, double, const ContactInputs<DROGUE_INSTANCE_SPACE>&);

}  // namespace drogue::fabric
