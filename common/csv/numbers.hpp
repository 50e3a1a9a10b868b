#pragma once

#include <string>
#include <string_view>

namespace drogue::csv {

/// What came of reading a number.
enum class NumberError { none, no_number, not_finite };

/// Reads all of `text` as a decimal number. Words for infinity and what a double cannot hold are
/// `not_finite`; what is too small for a double is 0.
NumberError parse_number(std::string_view text, double& value);

/// Appends the shortest text that reads back as the same number; nothing where there is no number.
void append_number(std::string& out, double value);
void append_number(std::string& out, int value);

}  // namespace drogue::csv
