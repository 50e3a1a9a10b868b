#include "common/run/files/output_path.hpp"

#include <sys/stat.h>

#include <charconv>
#include <string>

namespace drogue::run {

bool is_replaced(const std::filesystem::path& path) {
  if (own_descriptor(path) >= 0) return false;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  // Opening a directory for writing fails later, with its own message.
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status) ||
         std::filesystem::is_directory(status);
}

int own_descriptor(std::filesystem::path path) {
  constexpr int most_links = 40;  // as the kernel follows
  std::error_code error;
  const std::filesystem::path own_folder = std::filesystem::canonical("/proc/self/fd", error);
  if (error) return -1;
  for (int link = 0; link < most_links; ++link) {
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    const std::filesystem::path folder = std::filesystem::canonical(parent, error);
    if (error) return -1;
    if (folder == own_folder) {
      const std::string name = path.filename();
      int descriptor = -1;
      const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
      return wrong == std::errc{} && end == name.data() + name.size() ? descriptor : -1;
    }
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) return -1;
    path = folder / next;  // `next` alone, if it starts at the root
  }
  return -1;
}

bool is_same_file(const std::filesystem::path& one, const std::filesystem::path& other) {
  struct stat a = {}, b = {};
  return stat(one.c_str(), &a) == 0 && stat(other.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

}  // namespace drogue::run
