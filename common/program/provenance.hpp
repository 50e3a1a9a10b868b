#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace drogue {

/// What the build system knew; fixed at compile time.
struct BuildFacts {
  std::string version;
  std::string git;       ///< hash of the commit, `-dirty` appended if the tree had changes
  std::string compiler;  ///< name and version of the host compiler
  std::string flags;
  std::string mpi;       ///< version, or `no`
  std::string hdf5;
  std::string hypre;
};

BuildFacts build_facts();

/// Model name of the processor, `unknown` where the system does not tell.
std::string cpu_model();

/// Now, UTC, ISO 8601: `2025-01-31T12:00:00Z`.
std::string utc_date();

/// Largest resident set of this process so far, bytes.
std::int64_t host_peak_bytes();

/// What --version prints. `device_facts` are the lines that only kernels know: Kokkos version, compiled backends.
std::string version_text(const std::string& program,
                         const std::vector<std::pair<std::string, std::string>>& device_facts);

}  // namespace drogue
