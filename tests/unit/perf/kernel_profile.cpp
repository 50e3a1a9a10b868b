#include "perf/profile/kernel_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/program/failure.hpp"
#include "common/run/files/temporary_folder.hpp"

namespace drogue::perf {
namespace {

TEST(KernelLabel, IsTheNameOfTheFunctor) {
  const std::pair<const char*, const char*> cases[] = {
      {"void Kokkos::Impl::cuda_parallel_launch_local_memory<Kokkos::Impl::ParallelFor<drogue::flow::"
       "MomentumFunctor<Kokkos::Cuda, (drogue::flow::Advection)2, (bool)1>, "
       "Kokkos::TeamPolicy<Kokkos::Cuda>, "
       "Kokkos::Cuda>, (unsigned int)128, (unsigned int)4>(T1)",
       "drogue::flow::MomentumFunctor"},
      {"void drogue::device::persistent_kernel<(int)512, (int)1, drogue::fabric::PersistentResolutionFunctor<"
       "Kokkos::Cuda>>(T3, drogue::device::GridSync)",
       "drogue::fabric::PersistentResolutionFunctor"},
      {"void vector_fft<(unsigned int)128, (padding_t)0>(kernel_arguments_t<T1>)", "vector_fft"},
      {"axpy_kernel(int)", "axpy_kernel"}};
  for (const auto& [name, label] : cases) EXPECT_EQ(kernel_label(name), label);
}

/// A table with the columns that a profile must have.
class ProfileFile : public testing::Test {
 protected:
  static constexpr const char* header =
      "\"ID\",\"Kernel Name\",\"CC\",\"launch__block_size\",\"launch__registers_per_thread\","
      "\"launch__shared_mem_per_block_static\",\"launch__shared_mem_per_block_dynamic\","
      "\"launch__occupancy_limit_registers\",\"launch__occupancy_limit_shared_mem\","
      "\"launch__occupancy_limit_warps\",\"launch__occupancy_limit_blocks\",\"launch__grid_size\","
      "\"sm__warps_active.avg.pct_of_peak_sustained_active\",\"gpu__time_duration.sum\"\n"
      "\"\",\"\",\"\",\"\",\"register/thread\",\"byte/block\",\"byte/block\",\"block\",\"block\",\"block\","
      "\"block\",\"\",\"%\",\"ns\"\n";

  static std::string row(const std::string& resources, const std::string& grid, const std::string& active) {
    return "\"0\",\"void f<drogue::gas::StageFunctor<int, (bool)0>>(T1)\",\"9.0\"," + resources +
           ",\"3\",\"4\",\"16\",\"32\",\"" + grid + "\",\"" + active + "\",\"1,500\"\n";
  }

  std::vector<KernelProfile> read(const std::string& content) {
    std::ofstream(_file) << content;
    return read_profiles(_file);
  }

  std::string refusal(const std::string& content) {
    try {
      read(content);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::invalid_scene);
      return std::string(failure.what()).substr(_file.size());
    }
    return "";
  }

  const run::TemporaryFolder _folder{"drogue-test"};
  std::string _file = (_folder.path() / "kernels.csv").string();
};

constexpr const char* usual = "\"128\",\"168\",\"16\",\"15,344\"";

TEST_F(ProfileFile, ReadsKernelsBetweenOtherLines) {
  const auto found =
      read("==PROF== Connected\ntimer: 0.03 us\n" + std::string(header) + row(usual, "1,024", "12.5"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kernel, "drogue::gas::StageFunctor");
  EXPECT_EQ(found[0].capability, "9.0");
  EXPECT_EQ(found[0].threads, 128);
  EXPECT_EQ(found[0].registers, 168);
  EXPECT_EQ(found[0].shared_bytes, 15'360);
  EXPECT_EQ(found[0].carve_out, 0);
  EXPECT_EQ(found[0].by_registers, 3);
  EXPECT_EQ(found[0].by_shared_memory, 4);
  EXPECT_EQ(found[0].by_threads, 16);
  EXPECT_EQ(found[0].by_limit, 32);
  EXPECT_EQ(found[0].grid, 1024.0);
  EXPECT_DOUBLE_EQ(found[0].active_fraction, 0.125);
  EXPECT_EQ(found[0].place, _file + ":5");
}

TEST_F(ProfileFile, TakesTheDeviceFromItsAttributes) {
  std::string other(header);
  other.replace(
      other.find("\"CC\""), 4,
      "\"device__attribute_compute_capability_major\",\"device__attribute_compute_capability_minor\"");
  other.replace(other.find("\"\",\"\",\"\""), 8, "\"\",\"\",\"\",\"\"");
  std::string launch = row(usual, "1", "1");
  launch.replace(launch.find("\"9.0\""), 5, "\"10\",\"3\"");
  EXPECT_EQ(read(other + launch).at(0).capability, "10.3");
}

TEST_F(ProfileFile, MergesLaunchesWithEqualResources) {
  const auto found =
      read(std::string(header) + row(usual, "10", "5") + row(usual, "5,000", "12.5") + row(usual, "20", "6") +
           row("\"64\",\"168\",\"0\",\"0\"", "20", "(!) n/a") + header + row(usual, "30", "7"));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].launches, 1);
  EXPECT_TRUE(std::isnan(found[0].active_fraction));
  EXPECT_EQ(found[1].launches, 4);
  EXPECT_DOUBLE_EQ(found[1].duration, 6e-6);
  EXPECT_EQ(found[1].grid, 5000.0);
  EXPECT_DOUBLE_EQ(found[1].active_fraction, 0.125);
}

TEST_F(ProfileFile, ReportsErrorsOfNcuBesideProfiledKernels) {
  const std::string some = std::string(header) + row(usual, "10", "5");
  EXPECT_EQ(refusal(some + "==ERROR== Failed to profile kernel\n"),
            ": ncu reports beside the profiled kernels: ==ERROR== Failed to profile kernel");
  // ncu ended the program after the last launch that it was to profile.
  EXPECT_EQ(read(some + "==ERROR== The application returned an error code (9).\n").size(), 1U);
}

TEST_F(ProfileFile, ReportsLinesThatAreNoProfile) {
  const std::string good(header);
  EXPECT_EQ(
      refusal("gas-step 12.0 us\n"),
      ": no kernel in the layout of ncu --csv --page raw; drogue-perf ncu CASE prints the command that makes "
      "such a file");
  EXPECT_EQ(
      refusal("==ERROR== ERR_NVGPUCTRPERM - The user does not have permission\n"),
      ": no kernel in the layout of ncu --csv --page raw; ncu reports: ==ERROR== ERR_NVGPUCTRPERM - The user "
      "does not have permission");
  EXPECT_EQ(refusal(good + "\"0\",\"void f(T1)\",\"9.0\",\"128\"\n"),
            ":3: the line has 4 fields, the table 14 columns; is the file truncated?");
  EXPECT_EQ(refusal(good + row("\"128\",\"many\",\"0\",\"0\"", "1", "1")),
            ":3: \"many\" of column 'launch__registers_per_thread' is no number");
  EXPECT_EQ(
      refusal(good + row("\"128\",\"\",\"0\",\"0\"", "1", "1")),
      ":3: column 'launch__registers_per_thread' is absent or has no number; drogue-perf ncu CASE prints the "
      "command that makes such a file");
  EXPECT_EQ(refusal(good + row("\"0\",\"32\",\"0\",\"0\"", "1", "1")), ":3: the block has no threads");
  std::string rounded = good;
  rounded.replace(rounded.find("byte/block"), 10, "Kbyte/block");
  EXPECT_EQ(
      refusal(rounded + row("\"128\",\"32\",\"1.02\",\"0\"", "1", "1")),
      ":3: column 'launch__shared_mem_per_block_static' is in \"Kbyte/block\", which is rounded: give ncu "
      "--print-units base");
}

TEST_F(ProfileFile, RequiresFilesInAFolder) {
  EXPECT_THROW(read_profiles(_folder.path()), Failure);
  read(std::string(header) + row(usual, "10", "5"));
  EXPECT_EQ(read_profiles(_folder.path()).size(), 1U);
}

TEST(ProfilingCommand, NamesKernelsLaunchesAndProgram) {
  const std::string text = profiling_command(
      {"/bin/drogue-gas", "a scene.toml"}, "a b.csv",
      {.kernels = kernels_of_case("flow-step/cuda/64x64x64/periodic"), .skip = 20, .count = 7});
  EXPECT_TRUE(text.starts_with("ncu --csv --page raw --print-units base ")) << text;
  for (const char* part :
       {" --kernel-name 'regex:drogue::(flow|linear)' ", " --launch-skip 20 --launch-count 7 ",
        " --log-file 'a b.csv' ", ",launch__occupancy_limit_registers,", " /bin/drogue-gas 'a scene.toml'"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(ProfilingCommand, RejectsCasesOfHostsAndUnknownKinds) {
  for (const auto& [name, hint] : {std::pair{"gas-step/openmp/1024", "is no case on cuda"},
                                   std::pair{"gas-stepp/cuda/1024", "did you mean \"gas-step\"?"}})
    try {
      kernels_of_case(name);
      ADD_FAILURE() << name;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::usage);
      EXPECT_NE(std::string(failure.what()).find(hint), std::string::npos) << failure.what();
    }
}

}  // namespace
}  // namespace drogue::perf
