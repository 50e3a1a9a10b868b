#include "common/csv/numbers.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <system_error>

namespace drogue::csv {
namespace {

constexpr double powers_of_ten[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// Parses at most 15 digits with or without a point. Digits and power of ten are exact doubles, so one
/// division rounds correctly (Clinger 1990). Returns false for all other text.
bool parse_short(std::string_view text, double& value) {
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  constexpr std::size_t most_digits = std::size(powers_of_ten) - 1;
  if (text.empty() || text.size() > most_digits + 1 || text.front() == '.' || text.back() == '.')
    return false;
  const std::size_t none = text.size() - 1;
  std::size_t point = none;
  std::int64_t digits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int digit = text[i] - '0';
    if (digit >= 0 && digit <= 9) {
      digits = 10 * digits + digit;
    } else if (text[i] == '.' && point == none) {
      point = i;
    } else {
      return false;
    }
  }
  if (point == none && text.size() > most_digits) return false;
  const double magnitude = static_cast<double>(digits) / powers_of_ten[text.size() - 1 - point];
  value = is_negative ? -magnitude : magnitude;
  return true;
}

}  // namespace

NumberError parse_number(std::string_view text, double& value) {
  if (parse_short(text, value)) return NumberError::none;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (stopped != end || error == std::errc::invalid_argument) return NumberError::no_number;
  if (error == std::errc::result_out_of_range) {
    // std::from_chars reports overflow and underflow alike.
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
