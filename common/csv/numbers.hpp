#pragma once

#include <string>
#include <string_view>

namespace drogue::csv {

/// Result of parsing a number.
enum class NumberError { none, no_number, not_finite };

/// Parses all of `text` as a decimal number. `not_finite`: words for infinity, and overflow. Underflow gives
/// 0. Does not throw.
NumberError parse_number(std::string_view text, double& value);

/// Appends the shortest text that reads back as the same double; nothing for NaN.
void append_number(std::string& out, double value);
void append_number(std::string& out, int value);

}  // namespace drogue::csv
