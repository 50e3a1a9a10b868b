#include "common/program/signals.hpp"

#include <atomic>
#include <csignal>

namespace drogue {
namespace {

std::atomic<bool> interrupt_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

extern "C" void request_interrupt(int) { interrupt_requested.store(true, std::memory_order_relaxed); }

}  // namespace

void install_signal_handlers() {
  struct sigaction once = {};
  once.sa_handler = request_interrupt;
  // SA_RESETHAND: a second signal has the default action, which ends a program that does not reach its next
  // step.
  once.sa_flags = static_cast<int>(static_cast<unsigned>(SA_RESETHAND) | static_cast<unsigned>(SA_RESTART));
  sigemptyset(&once.sa_mask);
  sigaction(SIGINT, &once, nullptr);
  sigaction(SIGTERM, &once, nullptr);
  // Write errors report a full disk and a closed pipe.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() noexcept { return interrupt_requested.load(std::memory_order_relaxed); }

void clear_interrupt() {
  interrupt_requested.store(false, std::memory_order_relaxed);
  install_signal_handlers();
}

}  // namespace drogue
