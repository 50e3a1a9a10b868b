#include "tests/support/backend.hpp"

namespace drogue::testing {

// Constant-initialised, because test parameters depend on it before main starts.
constinit const device::Backend tested_backend = device::backend_of<DROGUE_TEST_SPACE>;

}  // namespace drogue::testing
