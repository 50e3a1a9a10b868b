#include "miniapps/options/output/price_rows.hpp"

#include <cmath>
#include <limits>

#include "common/csv/fields.hpp"
#include "common/csv/numbers.hpp"

namespace drogue::options_app {
namespace {

/// Fields `status` and `message`, with the commas around them.
const char* status_fields(const RowLayout& layout, const options::Price& price) {
  switch (price.status) {
    case options::PriceStatus::ok:
      return ",ok,";
    case options::PriceStatus::coarse:
      return ",coarse,";
    case options::PriceStatus::failed:
      break;
  }
  switch (price.failure) {
    case options::PricingFailure::discount_overflow:
      return ",failed,e^(-rate maturity) (of a call -dividend maturity) is too large a number";
    case options::PricingFailure::no_grid:
      return ",failed,no grid covers the distribution of the asset until maturity";
    case options::PricingFailure::unstable:
      return layout.grid_is_fixed
                 ? ",failed,the values grew without bound: more --steps or another --mesh or --method cos "
                   "may price it"
                 : ",failed,the values grew without bound on all grids that --tolerance tries: --mesh "
                   "and --steps together instead of it or --method cos may price it";
    case options::PricingFailure::stiff:
      return ",failed,the values grew without bound: too many jumps until maturity for any number of steps; "
             "--method cos may price it";
    case options::PricingFailure::coefficient_overflow:
      return ",failed,coefficients of the finite differences exceed the range of double; "
             "--method cos may price it";
    case options::PricingFailure::fourier_not_finite:
      return ",failed,the Fourier integral or series is not finite";
    case options::PricingFailure::none:
      break;
  }
  return ",failed,";
}

template <class Number>
void append_next(std::string& text, Number value) {
  text += ',';
  csv::append_number(text, value);
}

/// Completes a row without a price, whose id, strike and maturity are written, and counts it. A row without
/// an id is identified by its line number in the message.
void append_error(ResultBatch& batch, const RowLayout& layout, const ContractRow& row,
                  std::string_view message) {
  batch.prices += ",,,,,,,,,invalid,";
  csv::append_field(batch.prices, row.id.empty()
                                      ? "line " + std::to_string(row.line) + ": " + std::string(message)
                                      : std::string(message));
  batch.prices += layout.greeks ? ",,\n" : "\n";
  RowCounts& counts = batch.counts;
  ++counts.rows;
  if (counts.invalid++ > 0) return;
  counts.invalid_line = row.line;
  counts.invalid_message = message;
}

}  // namespace

std::string price_header(const RowLayout& layout) {
  return std::string(layout.surface ? "id,strike,maturity," : "id,") +
         "price,error,delta,gamma,theta,exercise_boundary,mesh,steps,status,message" +
         (layout.greeks ? ",vega,rho\n" : "\n");
}

void append_price(ResultBatch& batch, const RowLayout& layout, const ContractRow& row,
                  const options::Contract& contract, const options::Price& price,
                  const options::Sensitivities& sensitivities) {
  std::string& text = batch.prices;
  csv::append_field(text, row.id);
  if (layout.surface) {
    append_next(text, contract.strike);
    append_next(text, contract.maturity);
  }
  if (price.status == options::PriceStatus::failed) {
    text += ",,,,,,,,";
  } else {
    append_next(text, price.price);
    append_next(text, price.error);
    for (const double greek : {price.delta, price.gamma, price.theta})
      append_next(text, layout.greeks ? greek : std::numeric_limits<double>::quiet_NaN());
    append_next(text, price.exercise_boundary);
    append_next(text, price.mesh);
    append_next(text, price.steps);
  }
  text += status_fields(layout, price);
  if (layout.greeks) {
    append_next(text, sensitivities.vega);
    append_next(text, sensitivities.rho);
  }
  text += '\n';
  RowCounts& counts = batch.counts;
  ++counts.rows;
  if (price.status == options::PriceStatus::coarse) ++counts.coarse;
  if (price.status == options::PriceStatus::failed && counts.failed++ == 0) counts.failed_line = row.line;
  if (price.status != options::PriceStatus::failed)
    counts.largest_error = std::fmax(counts.largest_error, price.error / contract.strike);
}

void append_invalid(ResultBatch& batch, const RowLayout& layout, const ContractRow& row) {
  csv::append_field(batch.prices, row.id);
  if (layout.surface) batch.prices += ",,";
  append_error(batch, layout, row, row.error_message);
}

void append_invalid_point(ResultBatch& batch, const RowLayout& layout, const ContractRow& row, double strike,
                          double maturity, std::string_view message) {
  csv::append_field(batch.prices, row.id);
  append_next(batch.prices, strike);
  append_next(batch.prices, maturity);
  append_error(batch, layout, row, message);
  ++batch.counts.invalid_points;
}

void append_boundary(ResultBatch& batch, const ContractRow& row, double maturity,
                     std::span<const options::BoundaryPoint> points) {
  for (const options::BoundaryPoint& point : points) {
    csv::append_field(batch.boundaries, row.id);
    append_next(batch.boundaries, point.time);
    append_next(batch.boundaries, point.spot);
    append_next(batch.boundaries, maturity);
    batch.boundaries += '\n';
  }
}

}  // namespace drogue::options_app
