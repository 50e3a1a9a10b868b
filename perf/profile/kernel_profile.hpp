#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Profiles of kernels by Nsight Compute (`ncu --csv --page raw`), and the command that makes one.
namespace drogue::perf {

/// Launches of one kernel with equal resources, as ncu reports them.
struct KernelProfile {
  std::string kernel;       ///< label: name of the functor, "drogue::gas::StepFunctor"
  std::string place;        ///< FILE:LINE of the first launch
  std::string device;       ///< name of the device; empty: unknown
  std::string capability;   ///< compute capability of the device, "9.0"
  int multiprocessors = 0;  ///< of the device; 0: unknown
  int threads = 0;          ///< per block
  int registers = 0;        ///< per thread
  int shared_bytes = 0;     ///< static and dynamic, per block
  int carve_out = 0;        ///< shared memory of a multiprocessor in these launches, bytes; 0: unknown
  int by_registers = 0, by_shared_memory = 0, by_threads = 0, by_limit = 0;  ///< limits of resident blocks
  double grid = 0.0;                                                         ///< blocks of the largest launch
  /// Mean number of resident warps of that launch over the largest one, by the counters of the
  /// multiprocessors while they worked; NaN: not measured.
  double active_fraction = 0.0;
  int launches = 0;
  double duration = 0.0;  ///< of all launches, s; 0: not measured

  /// True for a kernel of the project, not of a library. Does not throw.
  [[nodiscard]] bool is_own() const { return kernel.starts_with(project); }
  /// Label without the namespace of the project.
  [[nodiscard]] std::string name() const { return is_own() ? kernel.substr(project.size()) : kernel; }

 private:
  static constexpr std::string_view project = "drogue::";
};

/// Name of the functor in a demangled name of a kernel of Kokkos or of `device::PersistentKernel`, without
/// template arguments; of other kernels the name of the function. Does not throw.
std::string kernel_label(std::string_view demangled);

/// The profiles of a CSV file, or of all `*.csv` of a folder, by label, block and resources; launches with
/// equal ones are merged. A file may hold several tables with their headers. Throws Failure: usage for a
/// missing path and a folder without such files, invalid_scene with FILE:LINE for another content, numbers
/// that are rounded or missing, a file without kernels, and errors that ncu reports.
std::vector<KernelProfile> read_profiles(const std::filesystem::path& path);

/// Kinds of cases of `drogue-perf run` on any machine: the parts of their names before the first slash. Does
/// not throw.
std::vector<std::string> case_kinds();

/// Launches that ncu profiles.
struct ProfiledLaunches {
  std::string kernels;  ///< regular expression for the demangled names
  int skip = 0;         ///< matching launches before the first one that is profiled
  int count = 300;      ///< then ncu ends the program
};

/// Command line that profiles launches of `command`, the words of a program and its arguments, and writes the
/// CSV file `out`. Does not throw.
std::string profiling_command(const std::vector<std::string>& command, const std::string& out,
                              const ProfiledLaunches& launches);

/// Regular expression for the kernels of `case_name`, a case of `drogue-perf run` on CUDA: those of its
/// namespaces. Throws Failure(usage) for a case of another backend or of an unknown kind, with the nearest
/// one.
std::string kernels_of_case(const std::string& case_name);

}  // namespace drogue::perf
