#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/flow/control.hpp"
#include "kernels/flow/mac_grid.hpp"

namespace drogue::flow {

template <class ExecutionSpace>
using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
template <class ExecutionSpace>
using ControlView = Kokkos::View<Control, typename ExecutionSpace::memory_space>;

}  // namespace drogue::flow
