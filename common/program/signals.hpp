#pragma once

namespace drogue {

/// From now on the first SIGINT or SIGTERM sets `interrupted()`, a second one ends the process at once. A
/// file-size limit becomes a write error (EFBIG) instead of a deadly SIGXFSZ.
void install_signal_handlers();

/// True once a signal asked the program to end after the current step. Lock-free; cheap enough for every
/// step.
bool interrupted() noexcept;

/// Forgets a signal and listens for a first one again.
void clear_interrupt();

}  // namespace drogue
