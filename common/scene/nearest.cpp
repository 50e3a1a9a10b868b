#include "common/scene/nearest.hpp"

#include <algorithm>

namespace drogue::scene {

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> two_above(columns), above(columns), row(columns);
  for (std::size_t j = 0; j < columns; ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < columns; ++j) {
      const int replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], two_above[j - 2] + 1);
      }
    }
    two_above = above;
    above = row;
  }
  return above.back();
}

namespace {

/// Accepted number of edits: one per three letters, as more make another word ("heston" of "merton"). Up to
/// half of the nearest name may be missing at its end.
bool is_near(std::string_view word, std::string_view name) {
  const int edits = edit_distance(word, name);
  const auto letters = static_cast<int>(std::max(word.size(), name.size()));
  if (edits == 1 || name.starts_with(word)) return 2 * edits <= letters;
  return 3 * edits < letters;
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& valid) {
  if (valid.empty()) return std::nullopt;
  word = word.substr(0, 100);  // a fuzzed key may be as long as the file
  const auto distance = [word](const std::string& name) { return edit_distance(word, name); };
  const auto found = std::min_element(
      valid.begin(), valid.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return is_near(word, *found) ? std::optional(*found) : std::nullopt;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& valid) {
  if (valid.empty()) return "no name is valid here";
  if (const auto found = nearest(word, valid)) return "did you mean \"" + *found + "\"?";
  std::string all;
  for (const std::string& name : valid) all += (all.empty() ? "" : ", ") + name;
  return (valid.size() == 1 ? "the only valid name is " : "valid names are ") + all;
}

}  // namespace drogue::scene
