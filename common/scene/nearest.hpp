#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drogue::scene {

/// Edit distance of two words: insertions, deletions, replacements, swaps of neighbours.
int edit_distance(std::string_view a, std::string_view b);

/// Valid word nearest to a mistyped one, none if none is near. Does not throw.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& valid);

/// Text `did you mean "cells"?` for the nearest valid word, or all valid words if none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& valid);

}  // namespace drogue::scene
