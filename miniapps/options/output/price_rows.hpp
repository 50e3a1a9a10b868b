#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kernels/options/contract.hpp"
#include "kernels/options/pricer.hpp"
#include "miniapps/options/chunk.hpp"
#include "miniapps/options/row_reader.hpp"

namespace drogue::options_app {

/// What rows of prices hold beside prices.
struct Layout {
  bool surface = false;     ///< the strike and the maturity, behind the id
  bool greeks = false;      ///< delta, gamma, theta; else their fields are empty
  bool grid_given = false;  ///< by mesh and steps, which then may be advised; else the tolerance chooses
};

/// The line that names the columns of the prices.
[[nodiscard]] std::string price_header(const Layout& layout);

/// Appends a row that was priced: a number that is none gives an empty field.
void append_price(Piece& piece, const Layout& layout, const Row& row, const options::Contract& contract,
                  const options::Price& price);

/// Appends a row with a fault.
void append_invalid(Piece& piece, const Layout& layout, const Row& row);

/// Appends a strike and maturity of a surface that the parameter set of `row`, which is valid, has no price
/// for.
void append_invalid_point(Piece& piece, const Row& row, double strike, double maturity,
                          std::string_view fault);

/// The line that names the columns of exercise boundaries.
inline constexpr const char* boundary_header = "id,time,spot\n";

/// Appends a row a point.
void append_boundary(Piece& piece, const Row& row, std::span<const options::BoundaryPoint> points);

}  // namespace drogue::options_app
