#include "common/csv/line_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/program/failure.hpp"
#include "common/run/files/io_error.hpp"

namespace drogue::csv {
namespace {

constexpr std::size_t block = std::size_t{1} << 20;
static_assert(block > 2 * LineReader::longest);

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

/// True for fields that are empty or quoted blanks.
bool is_empty_row(std::string_view text) {
  return text.find_first_not_of(" \t,\"") == std::string_view::npos &&
         text.find("\"\"\"") == std::string_view::npos && std::count(text.begin(), text.end(), '"') % 2 == 0;
}

}  // namespace

LineReader::LineReader(std::filesystem::path file) : _file(std::move(file)), _buffer(block) {
  // A batch is read twice, which a pipe does not allow.
  _descriptor = open(_file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (_descriptor < 0) {
    if (errno != ENOENT && errno != ENOTDIR) throw run::io_failure("open", _file, errno);
    throw Failure(ExitCode::usage, "there is no file '" + _file.string() + "'");
  }
  struct stat facts = {};
  const bool known = fstat(_descriptor, &facts) == 0;
  if (!known || !S_ISREG(facts.st_mode)) {
    close(_descriptor);
    throw Failure(ExitCode::usage, "'" + _file.string() + "' is " +
                                       (known && S_ISDIR(facts.st_mode) ? "a directory" : "no regular file") +
                                       ", where a CSV file is needed");
  }
  _size = facts.st_size;
}

LineReader::~LineReader() { close(_descriptor); }

double LineReader::share() const {
  const auto done = static_cast<double>(_read - static_cast<std::int64_t>(_end - _begin));
  return _size > 0 ? std::min(1.0, done / static_cast<double>(_size)) : 1.0;
}

/// Moves unread bytes to the front and reads more behind them; false at the end of the file.
bool LineReader::fill() {
  std::memmove(_buffer.data(), _buffer.data() + _begin, _end - _begin);
  _end -= _begin;
  _begin = 0;
  for (;;) {
    const ssize_t got = read(_descriptor, _buffer.data() + _end, _buffer.size() - _end);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw run::io_failure("read", _file, errno);
    _end += static_cast<std::size_t>(got);
    _read += got;
    return got > 0;
  }
}

void LineReader::skip_to_line_end() {
  for (;;) {
    const void* found = std::memchr(_buffer.data() + _begin, '\n', _end - _begin);
    if (found != nullptr) {
      _begin = static_cast<std::size_t>(static_cast<const char*>(found) - _buffer.data()) + 1;
      return;
    }
    _begin = _end;
    if (!fill()) return;
  }
}

bool LineReader::next_line(Line& line) {
  std::size_t searched = 0;
  std::size_t length = 0;
  bool ended = false;
  for (;;) {
    const void* found = std::memchr(_buffer.data() + _begin + searched, '\n', _end - _begin - searched);
    if (found != nullptr) {
      length = static_cast<std::size_t>(static_cast<const char*>(found) - _buffer.data()) - _begin;
      ended = true;
      break;
    }
    length = searched = _end - _begin;
    if (length > longest || !fill()) break;
  }
  if (!ended && length == 0) return false;
  line.number = ++_number;
  line.too_long = length > longest;
  line.text = {_buffer.data() + _begin, std::min(length, longest)};
  line.holds_cr = line.too_long && line.text.find('\r') != std::string_view::npos;
  if (ended) {
    _begin += length + 1;
    if (line.text.ends_with('\r')) line.text.remove_suffix(1);
  } else if (!line.too_long) {
    _begin = _end;
  } else {
    // The next read overwrites the returned bytes; the text of an overlong line is not needed.
    line.text = {};
    skip_to_line_end();
  }
  if (_number == 1 && line.text.starts_with(byte_order_mark)) line.text.remove_prefix(byte_order_mark.size());
  return true;
}

bool LineReader::next(Line& line) {
  while (next_line(line))
    if (line.too_long || !(is_blank(line.text) || (_skips_empty_rows && is_empty_row(line.text))))
      return true;
  return false;
}

}  // namespace drogue::csv
