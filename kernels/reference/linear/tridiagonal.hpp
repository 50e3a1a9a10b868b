#pragma once

#include <vector>

namespace drogue::reference {

/// Solution of below_i x_{i-1} + diagonal_i x_i + above_i x_{i+1} = right_i, i = 0 .. n - 1, by Gaussian
/// elimination with partial pivoting in long double. Does not read below_0 and above_{n-1}.
[[nodiscard]] std::vector<double> solve_tridiagonal(const std::vector<double>& below,
                                                    const std::vector<double>& diagonal,
                                                    const std::vector<double>& above,
                                                    const std::vector<double>& right);

}  // namespace drogue::reference
