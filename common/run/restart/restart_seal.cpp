#include "common/run/restart/restart_seal.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <vector>

#include "common/run/files/io_error.hpp"
#include "common/run/restart/checksum.hpp"

namespace drogue::run {
namespace {

constexpr const char* format_name = "drogue.restart/";
constexpr const char* format = "drogue.restart/1";

[[noreturn]] void unreadable(const std::filesystem::path& file, const std::string& reason) {
  throw Failure(ExitCode::io_error, "cannot continue from restart file '" + file.string() + "': " + reason);
}

struct Seal {
  std::string format, scene, checksum;
  std::uint64_t bytes = 0;
};

std::string checksum_after_seal(std::ifstream& stream, const std::filesystem::path& file) {
  std::vector<char> buffer(1U << 20U);
  Checksum checksum;
  stream.clear();
  stream.seekg(seal_bytes);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    checksum.add({buffer.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (stream.bad()) throw io_failure("read", file, errno);
  return hexadecimal(checksum.value());
}

Seal read_seal(std::ifstream& stream) {
  std::string block(seal_bytes, '\0');
  stream.read(block.data(), static_cast<std::streamsize>(block.size()));
  std::istringstream words(block.substr(0, block.find('\0')));
  Seal seal;
  words >> seal.format >> seal.bytes >> seal.checksum >> seal.scene;
  return seal;
}

}  // namespace

void write_seal(const std::filesystem::path& file, const std::string& scene) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw io_failure("read", file, errno);
  std::ostringstream words;
  words << format << '\n'
        << std::filesystem::file_size(file) << '\n'
        << checksum_after_seal(stream, file) << '\n'
        << scene << '\n';
  std::fstream seal(file, std::ios::binary | std::ios::in | std::ios::out);
  seal << words.str();
  seal.close();
  if (!seal) throw io_failure("write", file, errno);
}

void check_seal(const std::filesystem::path& file, const std::string& scene,
                const DescribeDifference& describe_difference) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw io_failure("open restart file", file, errno);
  const Seal seal = read_seal(stream);
  if (!seal.format.starts_with(format_name)) unreadable(file, "it is not a restart file of Drogue");
  if (seal.format != format)
    unreadable(file, "its format is " + seal.format + ", this program reads " + format);
  std::error_code ignored;
  if (std::filesystem::file_size(file, ignored) != seal.bytes) unreadable(file, "it is truncated");
  if (checksum_after_seal(stream, file) != seal.checksum)
    unreadable(file, "it is damaged, its checksum is wrong");
  if (seal.scene == scene) return;
  const std::string difference = describe_difference ? describe_difference(seal.scene) : "";
  unreadable(file, "it belongs to another scene" + (difference.empty() ? "" : ": " + difference));
}

}  // namespace drogue::run
