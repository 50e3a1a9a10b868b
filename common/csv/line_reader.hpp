#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace drogue::csv {

/// One line of a file, its end (LF or CRLF) taken off.
struct Line {
  std::string_view text;    ///< valid until the next line is read
  std::int64_t number = 0;  ///< counted from 1
  bool too_long = false;
};

/// Reads a file line by line in memory that does not grow with it. Blank lines and a byte-order mark are
/// passed over.
class LineReader {
 public:
  /// Bytes of the longest line that is given whole.
  static constexpr std::size_t longest = 65536;

  /// Throws Failure(usage) for what is missing or no file, Failure(io_error) for what cannot be opened.
  explicit LineReader(std::filesystem::path file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// False at the end. Throws Failure(io_error) where reading fails.
  bool next(Line& line);

  [[nodiscard]] const std::filesystem::path& file() const { return _file; }

  /// What part of the file has been read, 0 .. 1.
  [[nodiscard]] double share() const;

 private:
  bool next_line(Line& line);
  bool fill();
  void skip_to_line_end();

  std::filesystem::path _file;
  int _descriptor = -1;
  std::vector<char> _buffer;
  std::size_t _begin = 0, _end = 0;  ///< of what is unread in `_buffer`
  std::int64_t _size = 0, _read = 0, _number = 0;
};

}  // namespace drogue::csv
