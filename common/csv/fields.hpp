#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace drogue::csv {

/// Fields of a CSV line (RFC 4180): unquoted, without surrounding blanks.
class Fields {
 public:
  /// Splits `line`, which must outlive the fields. Returns the fault as a clause, or an empty text; after a
  /// fault the fields before it are kept, none of a line that is not UTF-8. Does not throw.
  std::string_view split(std::string_view line);

  /// Removes empty fields at the end beyond `count`, which spreadsheets write. Does not throw.
  void drop_trailing_empty(std::size_t count) {
    while (_values.size() > count && _values.back().empty()) _values.pop_back();
  }

  [[nodiscard]] std::size_t size() const { return _values.size(); }
  [[nodiscard]] std::string_view operator[](std::size_t i) const { return _values[i]; }

 private:
  std::string_view split_quoted(std::string_view line);

  std::vector<std::string_view> _values;
  std::deque<std::string> _unquoted;  ///< fields with a doubled quote
};

/// True for control characters, which no name may hold.
[[nodiscard]] bool is_control(char c);

/// Short, quoted, single-line form of a text for messages.
[[nodiscard]] std::string shown(std::string_view text);

/// Appends `text` as a field, quoted where necessary.
void append_field(std::string& out, std::string_view text);

}  // namespace drogue::csv
