#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drogue {

/// The candidate with the smallest edit distance (Damerau-Levenshtein, adjacent swaps count one) to `name`, the
/// first of equals; empty if none is near, that is, if more than a third of its letters (at least 2) would change.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace drogue
