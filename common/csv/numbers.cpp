#include "common/csv/numbers.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace drogue::csv {

NumberError parse_number(std::string_view text, double& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (stopped != end || error == std::errc::invalid_argument) return NumberError::no_number;
  if (error == std::errc::result_out_of_range) {
    // Too large and too small come as one.
    value = std::strtod(std::string(text).c_str(), nullptr);
  }
  return std::isfinite(value) ? NumberError::none : NumberError::not_finite;
}

void append_number(std::string& out, double value) {
  if (std::isnan(value)) return;
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  out.append(text, end);
}

void append_number(std::string& out, int value) {
  char text[16];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  out.append(text, end);
}

}  // namespace drogue::csv
