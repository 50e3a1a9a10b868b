#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace drogue::perf {

/// Text as printf prints it. Throws only std::bad_alloc.
[[gnu::format(printf, 1, 2)]] inline std::string printed(const char* format, ...) {
  std::va_list arguments, same;
  va_start(arguments, format);
  va_copy(same, arguments);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, same)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, arguments);
  va_end(same);
  va_end(arguments);
  return text;
}

}  // namespace drogue::perf
