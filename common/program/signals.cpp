#include "common/program/signals.hpp"

#include <atomic>
#include <csignal>

namespace drogue {
namespace {

std::atomic<bool> interrupt_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

extern "C" void request_interrupt(int) { interrupt_requested.store(true, std::memory_order_relaxed); }

void request_interrupt_at(int number, unsigned flags) {
  struct sigaction action = {};
  action.sa_handler = request_interrupt;
  action.sa_flags = static_cast<int>(flags | static_cast<unsigned>(SA_RESTART));
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

bool is_ignored(int number) {
  struct sigaction present = {};
  return sigaction(number, nullptr, &present) == 0 && present.sa_handler == SIG_IGN;
}

}  // namespace

void install_signal_handlers() {
  // SA_RESETHAND: a second signal has the default action, which ends a program that does not reach its next
  // step.
  for (const int number : {SIGINT, SIGTERM}) request_interrupt_at(number, SA_RESETHAND);
  for (const int number : {SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM}) request_interrupt_at(number, 0);
  if (!is_ignored(SIGHUP)) request_interrupt_at(SIGHUP, 0);
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
