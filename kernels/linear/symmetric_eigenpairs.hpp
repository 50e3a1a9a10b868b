#pragma once

#include <vector>

namespace drogue::linear {

/// Eigenvalues of a symmetric matrix, ascending, and normalised eigenvectors, column after column.
struct Eigenpairs {
  std::vector<double> values, vectors;
};

/// Eigenpairs of a symmetric matrix, column after column, of n^2 numbers: Householder's tridiagonalisation,
/// which a tridiagonal matrix skips, and implicit QR steps with Wilkinson's shifts (Golub and Van Loan 2013,
/// algorithms 8.3.1 to 8.3.3). Errors of the eigenvalues, and residuals of the eigenvectors, are of the order
/// of round-off times the norm of the matrix. Throws std::runtime_error for entries that are not finite.
[[nodiscard]] Eigenpairs symmetric_eigenpairs(std::vector<double> matrix);

}  // namespace drogue::linear
