#pragma once

namespace drogue {

/// Installs handlers: the first SIGINT or SIGTERM sets `interrupted()`, a second one ends the process. A
/// file-size limit becomes a write error (EFBIG) instead of a deadly SIGXFSZ.
void install_signal_handlers();

/// True after a signal requested the end of the program. Lock-free and cheap enough for every step.
bool interrupted() noexcept;

/// Clears the request and installs the handlers again.
void clear_interrupt();

}  // namespace drogue
