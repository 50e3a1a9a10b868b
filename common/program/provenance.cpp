#include "common/program/provenance.hpp"

#include <sys/resource.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

#include "common/version.hpp"

namespace drogue {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    // Keys of /proc/cpuinfo: `model name` on x86, `cpu` on POWER, neither on ARM.
    const bool named = line.starts_with("model name") || line.starts_with("cpu\t");
    if (named && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string utc_date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  gmtime_r(&now, &utc);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text, length};
}

std::int64_t host_peak_bytes() {
  // getrusage() would include the peak of the parent process.
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM:")) return std::int64_t{1024} * std::atoll(line.c_str() + 6);
  }
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

std::string version_text(const std::string& program) {
  const BuildInfo& build = build_info();
  std::string text = program + " " + std::string(build.version) + "\n";
  const auto line = [&text](const char* name, std::string_view value) {
    text += std::string(name) + ": " + std::string(value.empty() ? "none" : value) + "\n";
  };
  line("git", build.git);
  line("Kokkos", build.kokkos);
  line("backends", build.backends);
  line("MPI", build.mpi);
  line("HDF5", build.hdf5);
  line("FFTW", build.fftw);
  line("hypre", build.hypre);
  line("NCCL", build.nccl);
  line("compiler", build.compiler);
  line("flags", build.flags);
  return text;
}

}  // namespace drogue
