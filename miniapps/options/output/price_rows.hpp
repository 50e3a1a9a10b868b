#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kernels/options/contract.hpp"
#include "kernels/options/pricer.hpp"
#include "kernels/options/sensitivities.hpp"
#include "miniapps/options/input/row_reader.hpp"
#include "miniapps/options/output/result_batch.hpp"

namespace drogue::options_app {

/// Layout of the rows of prices.
struct RowLayout {
  bool surface = false;        ///< strike and maturity follow the id
  bool greeks = false;         ///< delta, gamma and theta are filled in, and vega and rho follow the message;
                               ///< else the fields of the former are empty
  bool grid_is_fixed = false;  ///< mesh and steps are options of the run; else the tolerance chooses them
};

/// Header line of the file of prices.
[[nodiscard]] std::string price_header(const RowLayout& layout);

/// Appends the row of a priced contract and counts it. NaN becomes an empty field.
void append_price(ResultBatch& batch, const RowLayout& layout, const ContractRow& row,
                  const options::Contract& contract, const options::Price& price,
                  const options::Sensitivities& sensitivities);

/// Appends and counts an invalid row, which has an error message.
void append_invalid(ResultBatch& batch, const RowLayout& layout, const ContractRow& row);

/// Appends and counts a point of a surface that is invalid although its parameter set `row` is valid.
/// `strike` in money, `maturity` in years.
void append_invalid_point(ResultBatch& batch, const RowLayout& layout, const ContractRow& row, double strike,
                          double maturity, std::string_view message);

/// Header line of the file of exercise boundaries.
inline constexpr const char* boundary_header = "id,time,spot,maturity\n";

/// Appends one line per point of an exercise boundary of an option with this time to expiry, years.
void append_boundary(ResultBatch& batch, const ContractRow& row, double maturity,
                     std::span<const options::BoundaryPoint> points);

}  // namespace drogue::options_app
