#pragma once

#include <string_view>

#include "kernels/options/contract.hpp"

namespace drogue::options {

/// The first condition that the contract breaks, as a clause like "|beta + 1| < alpha, else the asset has no
/// mean"; empty if it can be priced. Only the parameters of its model are looked at.
[[nodiscard]] std::string_view violated_condition(const Contract& contract);

}  // namespace drogue::options
