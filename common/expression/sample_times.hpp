#pragma once

#include <string>
#include <vector>

namespace drogue::expression {

/// Times from 0 to `end` at which to check an expression of `variables`, the last of which is the time, in
/// ascending order: even parts, and the numbers of the expression, where it may jump or have a pole. 0 alone
/// without the time. Throws ExpressionError.
[[nodiscard]] std::vector<double> sample_times(const std::string& text,
                                               const std::vector<std::string>& variables, double end);

}  // namespace drogue::expression
