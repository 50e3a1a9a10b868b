#pragma once

#include <array>

#include "kernels/gas/parameters.hpp"

namespace drogue::reference {

/// Smoothness indicators of the three candidate stencils of f[i-2..i+2] (Jiang and Shu 1996, eq. 3.1 ff.).
/// Does not throw.
[[nodiscard]] std::array<double, 3> smoothness(const std::array<double, 5>& f);

/// Nonlinear weights of the left-biased value at i+1/2; their sum is 1, and they tend to (1, 6, 3)/10 in
/// smooth flow. js: eps 1e-6. m: mapped js weights with eps 1e-40 (Henrick, Aslam and Powers 2005). z: power
/// 1 or 2, eps 1e-40 (Borges et al. 2008). teno5: cut-off 1e-5, eps 1e-40 (Fu, Hu and Adams 2016). Does not
/// throw.
[[nodiscard]] std::array<double, 3> weno_weights(const std::array<double, 5>& f, gas::Weno scheme, int power);

/// Left-biased value at i+1/2 from f[i-2..i+2], in the unit of f. Does not throw.
[[nodiscard]] double weno_face_value(const std::array<double, 5>& f, gas::Weno scheme, int power);

}  // namespace drogue::reference
