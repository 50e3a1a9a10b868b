#include "tests/support/backend.hpp"

namespace drogue::testing {

// Constant-initialised: tests choose their parameters by it before main starts.
constinit const device::Backend tested_backend = device::backend_of<DROGUE_TEST_SPACE>;

}  // namespace drogue::testing
