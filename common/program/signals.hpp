#pragma once

namespace drogue {

/// Installs handlers: SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU and SIGALRM set `interrupted()`. A
/// second SIGINT or SIGTERM ends the process; the others, which shells and batch systems send more than once,
/// may come again. A SIGHUP that was ignored, as under nohup, remains so. A file-size limit becomes a write
/// error (EFBIG) instead of a deadly SIGXFSZ.
void install_signal_handlers();

/// True after a signal requested the end of the program. Lock-free and cheap enough for every step.
bool interrupted() noexcept;

/// Clears the request and installs the handlers again.
void clear_interrupt();

}  // namespace drogue
