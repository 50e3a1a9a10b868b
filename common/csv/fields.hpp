#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace drogue::csv {

/// The fields of a line (RFC 4180), unquoted, blanks around them taken off.
class Fields {
 public:
  /// Splits `line`, which has to outlive the fields. Returns what is wrong with it as a clause, or nothing;
  /// the fields are those before the one that is wrong.
  std::string_view split(std::string_view line);

  [[nodiscard]] std::size_t size() const { return _values.size(); }
  [[nodiscard]] std::string_view operator[](std::size_t i) const { return _values[i]; }

 private:
  std::string_view split_quoted(std::string_view line);

  std::vector<std::string_view> _values;
  std::deque<std::string> _unquoted;  ///< those that held a doubled quote
};

/// Whether `c` has no place in a name: it moves a cursor, rings a bell, or ends a string.
[[nodiscard]] bool is_control(char c);

/// Text of a file as a sentence shows it: short, in quotes, on one line.
[[nodiscard]] std::string shown(std::string_view text);

/// Appends `text` as a field, quoted where it must be.
void append_field(std::string& out, std::string_view text);

}  // namespace drogue::csv
