#pragma once

#include <sched.h>

#include <cstdint>
#include <optional>

namespace drogue::device {

/// Cores of the host at one moment.
struct HostCores {
  int allowed = 1;  ///< that this process may use
  int online = 1;   ///< of the machine
  int running = 1;  ///< threads of all processes that run or wait for a core, including the calling one
};

/// While it lives, the calling thread and the processes that it starts may use all cores of this process.
/// GCC's OpenMP binds the first thread to one place before `main` if OMP_PROC_BIND or OMP_PLACES says so.
/// Throws only std::bad_alloc.
class UnboundThread {
 public:
  UnboundThread();
  ~UnboundThread();
  UnboundThread(const UnboundThread&) = delete;
  UnboundThread& operator=(const UnboundThread&) = delete;

 private:
  std::optional<cpu_set_t> _bound;  ///< what to return to
};

/// Cores of this host. `running` is the least of a few readings within some milliseconds; 1 where the system
/// does not count. Does not throw.
[[nodiscard]] HostCores host_cores();

/// True if a pool of `threads` threads would take cores from each other or from other programs. Does not
/// throw.
[[nodiscard]] bool are_cores_shared(int threads, const HostCores& cores);

/// Number of threads that pay for loops over `points` points, if a thread with fewer than `points_per_thread`
/// costs more than it saves. At least 1. Does not throw.
[[nodiscard]] int useful_threads(std::int64_t points, std::int64_t points_per_thread);

/// `useful_threads` if `shared` cores make the end of a loop, where threads wait for each other, dearer. Does
/// not throw.
[[nodiscard]] int useful_threads_on(bool shared, int useful_threads);

}  // namespace drogue::device
