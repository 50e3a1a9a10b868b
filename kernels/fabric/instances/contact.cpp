#include "kernels/fabric/contact_on.hpp"

namespace drogue::fabric {

template std::unique_ptr<ContactSteps<DROGUE_INSTANCE_SPACE>> make_contact(
    const Parameters&, const ContactCloth<DROGUE_INSTANCE_SPACE>&);

}  // namespace drogue::fabric
