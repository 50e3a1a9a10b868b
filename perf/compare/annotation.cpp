#include "perf/compare/annotation.hpp"

#include <cstdio>

namespace drogue::perf {

namespace {

/// Escapes the characters that end an annotation or, in a property, its title.
std::string escape(const std::string& text, bool property) {
  std::string escaped;
  for (const char c : text) {
    const bool special = c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ','));
    char code[8];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    if (special)
      escaped += code;
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * fraction);
  return text;
}

std::string describe_change(const SpeedChange& change) {
  char text[128];
  std::snprintf(text, sizeof text, "takes %.3f times as long (%.3f to %.3f with 95 %% confidence)",
                change.ratio, change.low, change.high);
  return text;
}

std::string annotation(const ComparedCase& row, bool failed) {
  const bool worse = row.verdict == Verdict::slower || row.verdict == Verdict::error_changed;
  if (!worse && row.verdict != Verdict::faster) return "";
  const std::string level = failed ? "error" : worse ? "warning" : "notice";
  return "::" + level + " title=" + escape(row.name, true) +
         "::" + escape(row.speed ? describe_change(*row.speed) : row.reason, false) + "\n";
}

}  // namespace drogue::perf
