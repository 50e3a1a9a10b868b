#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace drogue::csv {

/// One line of a file without its end, LF or CRLF.
struct Line {
  std::string_view text;    ///< valid until the next line is read
  std::int64_t number = 0;  ///< counted from 1
  bool too_long = false;
  bool holds_cr = false;  ///< of a line that is too long: lines may end in CR alone
};

/// Reads a file line by line in constant memory. Skips blank lines and a byte-order mark.
class LineReader {
 public:
  /// Longest line that is returned whole, bytes.
  static constexpr std::size_t longest = 65536;

  /// Throws `Failure`: usage for a missing or non-regular file, io_error if it cannot be opened.
  explicit LineReader(std::filesystem::path file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// Reads the next line; false at the end. Throws `Failure` (io_error).
  bool next(Line& line);

  /// Lines of empty fields, quoted or not, are blank from now on: spreadsheets write rows of commas.
  void skip_empty_rows() { _skips_empty_rows = true; }

  [[nodiscard]] const std::filesystem::path& file() const { return _file; }

  /// Fraction of the bytes of the file up to the end of the last line that was returned, 0 to 1.
  [[nodiscard]] double share() const;

 private:
  bool next_line(Line& line);
  bool fill();
  void skip_to_line_end();

  std::filesystem::path _file;
  int _descriptor = -1;
  std::vector<char> _buffer;
  std::size_t _begin = 0, _end = 0;  ///< unread part of `_buffer`
  bool _skips_empty_rows = false;
  std::int64_t _size = 0, _read = 0, _number = 0;
};

}  // namespace drogue::csv
