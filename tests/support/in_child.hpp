#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

namespace drogue::testing {

/// Result of `work` in a child process, because Kokkos can be initialised only once per process.
inline std::string in_child(const std::function<std::string()>& work) {
  std::string file = ::testing::TempDir() + "drogue_exact_XXXXXX";
  const int descriptor = mkstemp(file.data());
  EXPECT_GE(descriptor, 0);
  close(descriptor);
  const pid_t child = fork();
  if (child == 0) {
    try {
      std::ofstream out(file, std::ios::binary);
      out << work();
      out.close();
      _exit(out ? 0 : 1);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      _exit(1);
    }
  }
  int status = 1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  unlink(file.c_str());
  return bytes;
}

}  // namespace drogue::testing
