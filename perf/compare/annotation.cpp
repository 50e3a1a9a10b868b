#include "perf/compare/annotation.hpp"

#include <algorithm>
#include <cmath>

#include "perf/rows/printed.hpp"

namespace drogue::perf {

namespace {

/// Escapes the characters that end an annotation or, in a property, its title.
std::string escape(const std::string& text, bool property) {
  std::string escaped;
  for (const char c : text) {
    const bool special = c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ','));
    escaped +=
        special ? printed("%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c))) : std::string(1, c);
  }
  return escaped;
}

}  // namespace

std::string percent(double fraction) { return printed("%.3g %%", 100.0 * fraction); }

std::string describe_change(const SpeedChange& change) {
  return printed("takes %.3f times as long (%.3f to %.3f with 95 %% confidence)", change.ratio, change.low,
                 change.high);
}

std::string describe(const ComparedCase& row) {
  if (!row.speed) return row.reason;
  return has_interval(*row.speed) ? describe_change(*row.speed)
                                  : "too few samples to show a change, which takes four a side at least";
}

std::string summary(const std::vector<ComparedCase>& rows) {
  const auto count = [&](Verdict verdict) {
    return std::ranges::count(rows, verdict, &ComparedCase::verdict);
  };
  const auto holding = [&](Presence presence) {
    return std::ranges::count(rows, presence, &ComparedCase::presence);
  };
  std::string sentence = printed(
      "%zu cases: %td unchanged, %td take longer, %td take less time, %td undecided, %td with another "
      "error, %td not compared (%td vanished, %td new)",
      rows.size(), count(Verdict::same), count(Verdict::slower), count(Verdict::faster),
      count(Verdict::ambiguous), count(Verdict::error_changed), count(Verdict::not_comparable),
      holding(Presence::old_alone), holding(Presence::new_alone));
  double logarithms = 0.0;
  int compared = 0;
  for (const ComparedCase& row : rows)
    if (row.speed) logarithms += std::log(row.speed->ratio), ++compared;
  if (compared == 0) return sentence;
  return sentence + printed("; %.3f times as long in the geometric mean of %d",
                            std::exp(logarithms / compared), compared);
}

nlohmann::json verdicts_json(const std::string& before, const std::string& after,
                             const std::vector<ComparedCase>& rows) {
  nlohmann::json cases = nlohmann::json::array();
  for (const ComparedCase& row : rows) {
    nlohmann::json made = {{"case", row.name},     {"verdict", word(row.verdict)},
                           {"reason", row.reason}, {"ratio", nullptr},
                           {"low", nullptr},       {"high", nullptr},
                           {"old_s", nullptr},     {"new_s", nullptr},
                           {"unit", row.unit}};
    if (row.speed) {
      made["ratio"] = row.speed->ratio, made["old_s"] = row.old_time, made["new_s"] = row.new_time;
      if (has_interval(*row.speed)) made["low"] = row.speed->low, made["high"] = row.speed->high;
    }
    cases.push_back(made);
  }
  return {{"old", before}, {"new", after}, {"summary", summary(rows)}, {"cases", cases}};
}

std::string annotation(const ComparedCase& row, bool failed) {
  const bool worse = row.verdict == Verdict::slower || row.verdict == Verdict::error_changed;
  if (!failed && !worse && row.verdict != Verdict::faster) return "";
  const std::string level = failed ? "error" : worse ? "warning" : "notice";
  return "::" + level + " title=" + escape(row.name, true) + "::" + escape(describe(row), false) + "\n";
}

}  // namespace drogue::perf
