#include "common/run/history_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "common/run/files/io_error.hpp"

namespace drogue::run {
namespace {

constexpr auto flush_interval = std::chrono::seconds(1);
constexpr std::size_t flush_bytes = 1 << 20;

void append_number(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  text.append(digits, end);
}

/// First line of `stream`, with its end; empty if no whole line is there. Throws `Failure` (io_error) unless
/// it is `expected` or empty.
std::string header_of(std::ifstream& stream, const std::filesystem::path& file, const std::string& expected) {
  std::string line;
  if (!std::getline(stream, line) || stream.eof()) return {};
  line += '\n';
  if (line != expected)
    throw Failure(ExitCode::io_error,
                  "cannot continue '" + file.string() + "': it has other columns than this run");
  return line;
}

/// Length of the header and all whole rows up to `time`, bytes; 0 without a header.
std::uintmax_t bytes_until(const std::filesystem::path& file, const std::string& expected_header,
                           double time) {
  std::ifstream stream(file, std::ios::binary);
  if (header_of(stream, file, expected_header).empty()) return 0;
  std::string line;
  std::uintmax_t bytes = expected_header.size();
  while (std::getline(stream, line) && !stream.eof()) {  // a row cut short by a kill has no line end
    double row_time = 0.0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), row_time);
    if (error != std::errc{} || row_time > time) break;
    bytes += line.size() + 1;
  }
  return bytes;
}

}  // namespace

std::string history_header(const std::vector<Column>& columns) {
  std::string line = "time [s]";
  for (const Column& column : columns) {
    line += "," + column.name + (column.unit.empty() ? "" : " [" + column.unit + "]");
  }
  return line + "\n";
}

void require_same_columns(const std::filesystem::path& file, const std::vector<Column>& columns) {
  if (access(file.c_str(), W_OK) != 0 && errno != ENOENT) throw io_failure("write", file, errno);
  std::ifstream stream(file, std::ios::binary);
  header_of(stream, file, history_header(columns));
}

HistoryWriter::HistoryWriter(std::filesystem::path file, const std::vector<Column>& columns,
                             std::optional<double> resume_time)
    : _file(std::move(file)), _width(columns.size()), _last_flush(std::chrono::steady_clock::now()) {
  const std::string first_line = history_header(columns);
  const std::uintmax_t kept = resume_time ? bytes_until(_file, first_line, *resume_time) : 0;
  _descriptor = open(_file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (_descriptor < 0) throw io_failure("write", _file, errno);
  if (ftruncate(_descriptor, static_cast<off_t>(kept)) != 0) {
    const int error = errno;
    close(_descriptor);
    throw io_failure("write", _file, error);
  }
  if (kept == 0) _pending = first_line;
  _continues = kept > first_line.size();
}

HistoryWriter::~HistoryWriter() {
  if (_descriptor < 0) return;
  try {
    flush();
  } catch (const Failure&) {
    // Another failure is being reported; finish() reports this one.
  }
  close(_descriptor);
}

void HistoryWriter::append(double time, std::span<const double> values) {
  if (values.size() != _width) throw std::logic_error("a row of history.csv needs one value per column");
  append_number(_pending, time);
  for (const double value : values) {
    _pending += ',';
    append_number(_pending, value);
  }
  _pending += '\n';
  if (_pending.size() > flush_bytes || std::chrono::steady_clock::now() - _last_flush > flush_interval)
    flush();
}

void HistoryWriter::flush() {
  _last_flush = std::chrono::steady_clock::now();
  std::size_t done = 0;
  while (done < _pending.size()) {
    const ssize_t written = write(_descriptor, _pending.data() + done, _pending.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      _pending.erase(0, done);
      throw io_failure("write", _file, error);
    }
    done += static_cast<std::size_t>(written);
  }
  _pending.clear();
}

void HistoryWriter::finish() {
  if (_descriptor < 0) return;
  flush();
  // A file that was deleted takes rows all the same, and the run its time: its state is in the restart file.
  struct stat opened {
  }, present{};
  if (fstat(_descriptor, &opened) != 0 || stat(_file.c_str(), &present) != 0 ||
      opened.st_ino != present.st_ino || opened.st_dev != present.st_dev)
    throw Failure(ExitCode::io_error, "'" + _file.string() + "' was deleted or replaced during the run");
  const int sync_error = fsync(_descriptor) == 0 ? 0 : errno;
  const int close_error = close(std::exchange(_descriptor, -1)) == 0 ? 0 : errno;
  if (sync_error != 0 || close_error != 0)
    throw io_failure("write", _file, sync_error != 0 ? sync_error : close_error);
}

}  // namespace drogue::run
