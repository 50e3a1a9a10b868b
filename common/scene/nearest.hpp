#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drogue::scene {

/// Edits (insert, delete, replace, swap of neighbours) that turn one word into another.
int edit_distance(std::string_view a, std::string_view b);

/// `did you mean "weno"?` for the nearest of the valid words, or all of them where none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& valid);

}  // namespace drogue::scene
