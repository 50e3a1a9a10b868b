#pragma once

#include <functional>
#include <vector>

#include "kernels/gas/parameters.hpp"

namespace drogue::reference {

/// Solves u_t + u_x = 0 on [-1, 1], periodic, by fifth-order WENO and SSP-RK3. Steps of `dt_factor` *
/// dx^(5/3) keep the third-order error in time below the fifth-order one in space. Returns the cell values at
/// `end_time`; the problem is dimensionless. Throws `std::bad_alloc`.
[[nodiscard]] std::vector<double> advect(std::size_t cells, const std::function<double(double)>& initial,
                                         double end_time, gas::Weno scheme, int power, double dt_factor);

}  // namespace drogue::reference
