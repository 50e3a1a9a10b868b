#pragma once

#include <string_view>

#include "kernels/options/contract.hpp"

namespace drogue::options {

/// First validity condition that the contract violates, as a clause like "|beta + 1| < alpha, else the asset
/// has no mean"; empty for a valid contract. Checks the jump parameters of the contract's model only. Does
/// not throw.
[[nodiscard]] std::string_view violated_condition(const Contract& contract);

}  // namespace drogue::options
