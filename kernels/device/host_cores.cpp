#include "kernels/device/host_cores.hpp"

#include <unistd.h>
#if defined(_OPENMP)
#include <omp.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

namespace drogue::device {
namespace {

constexpr int readings = 5;
constexpr std::chrono::milliseconds between_readings(1);

/// Points per thread on shared cores, in those on free ones. The end of a loop costs some 20 us instead of 2
/// there, if threads sleep while they wait.
constexpr int dearer = 8;

/// Cores of the calling thread; none on machines with more of them than the set can hold.
std::optional<cpu_set_t> cores_of_thread() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return {};
  return set;
}

/// Those of the process: of all places of OpenMP, where it binds threads.
std::optional<cpu_set_t> cores_of_process() {
  cpu_set_t set;
  CPU_ZERO(&set);
#if defined(_OPENMP)
  for (int place = 0; place < omp_get_num_places(); ++place) {
    std::vector<int> cores(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, cores.data());
    for (const int core : cores) CPU_SET(static_cast<std::size_t>(core), &set);
  }
#endif
  return CPU_COUNT(&set) > 0 ? set : cores_of_thread();
}

/// Threads that run or wait for a core, as proc(5) counts them; 1 if it does not.
int running_threads() {
  int running = 1;
  if (std::FILE* file = std::fopen("/proc/loadavg", "r")) {
    if (std::fscanf(file, "%*f %*f %*f %d/", &running) != 1) running = 1;
    std::fclose(file);
  }
  return std::max(1, running);
}

}  // namespace

UnboundThread::UnboundThread() {
  const auto cores = cores_of_process();  // some libraries of OpenMP bind the first thread here
  _bound = cores_of_thread();
  if (_bound) sched_setaffinity(0, sizeof *cores, &*cores);
}

UnboundThread::~UnboundThread() {
  if (_bound) sched_setaffinity(0, sizeof *_bound, &*_bound);
}

HostCores host_cores() {
  HostCores cores;
  cores.online = std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
  const auto allowed = cores_of_process();
  cores.allowed = allowed ? std::max(1, CPU_COUNT(&*allowed)) : cores.online;
  // One reading would take a thread that runs for an instant for a load.
  cores.running = running_threads();
  for (int i = 1; i < readings && cores.running > 1; ++i) {
    std::this_thread::sleep_for(between_readings);
    cores.running = std::min(cores.running, running_threads());
  }
  return cores;
}

bool are_cores_shared(int threads, const HostCores& cores) {
  return threads > 1 && (threads > cores.allowed || threads + cores.running - 1 > cores.online);
}

int useful_threads(std::int64_t points, std::int64_t points_per_thread) {
  constexpr std::int64_t most = 4096;
  return static_cast<int>(1 + std::min(points / points_per_thread, most));
}

int useful_threads_on(bool shared, int useful_threads) {
  return shared ? std::max(1, useful_threads / dearer) : useful_threads;
}

}  // namespace drogue::device
