#include "miniapps/options/price_text.hpp"

#include <limits>

#include "common/csv/fields.hpp"
#include "common/csv/numbers.hpp"

namespace drogue::options_app {
namespace {

const char* status(const Layout& layout, const options::Price& price) {
  switch (price.outcome) {
    case options::Outcome::ok:
      return ",ok,";
    case options::Outcome::coarse:
      return ",coarse,";
    case options::Outcome::failed:
      break;
  }
  switch (price.failure) {
    case options::Failure::too_large:
      return ",failed,e^(-rate maturity) (of a call -dividend maturity) is too large a number";
    case options::Failure::no_grid:
      return ",failed,no grid reaches as far as this law does until maturity";
    case options::Failure::grown:
      return layout.grid_given
                 ? ",failed,the values grew without bound: more --steps or another --mesh or --method cos "
                   "may price it"
                 : ",failed,the values grew without bound on all grids that --tolerance tries: --mesh "
                   "and --steps together instead of it or --method cos may price it";
    case options::Failure::stiff:
      return ",failed,the values grew without bound: more happens until maturity than steps can follow; "
             "--method cos may price it";
    case options::Failure::overflow:
      return ",failed,finite differences of this law and these rates need numbers beyond all range; "
             "--method cos may price it";
    case options::Failure::series:
      return ",failed,the Fourier integral or series of this law and maturity is not finite";
    case options::Failure::none:
      break;
  }
  return ",failed,";
}

template <class Number>
void append_next(std::string& text, Number value) {
  text += ',';
  csv::append_number(text, value);
}

/// Ends a row that begins like those of the layout and has no price.
void append_fault(Piece& piece, const Row& row, std::string_view fault) {
  piece.prices += ",,,,,,,,,invalid,";
  // Without an id the line is what tells which row it is.
  csv::append_field(piece.prices, row.id.empty()
                                      ? "line " + std::to_string(row.line) + ": " + std::string(fault)
                                      : std::string(fault));
  piece.prices += '\n';
  Tally& tally = piece.tally;
  ++tally.rows;
  if (tally.invalid++ > 0) return;
  tally.invalid_line = row.line;
  tally.invalid_fault = fault;
}

}  // namespace

std::string price_header(const Layout& layout) {
  return std::string(layout.surface ? "id,strike,maturity," : "id,") +
         "price,error,delta,gamma,theta,exercise_boundary,mesh,steps,status,message\n";
}

void append_price(Piece& piece, const Layout& layout, const Row& row, const options::Contract& contract,
                  const options::Price& price) {
  std::string& text = piece.prices;
  csv::append_field(text, row.id);
  if (layout.surface) {
    append_next(text, contract.strike);
    append_next(text, contract.maturity);
  }
  if (price.outcome == options::Outcome::failed) {
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
  text += status(layout, price);
  text += '\n';
  Tally& tally = piece.tally;
  ++tally.rows;
  if (price.outcome == options::Outcome::coarse) ++tally.coarse;
  if (price.outcome == options::Outcome::failed && tally.failed++ == 0) tally.failed_line = row.line;
}

void append_invalid(Piece& piece, const Layout& layout, const Row& row) {
  csv::append_field(piece.prices, row.id);
  if (layout.surface) piece.prices += ",,";
  append_fault(piece, row, row.fault);
}

void append_invalid_point(Piece& piece, const Row& row, double strike, double maturity,
                          std::string_view fault) {
  csv::append_field(piece.prices, row.id);
  append_next(piece.prices, strike);
  append_next(piece.prices, maturity);
  append_fault(piece, row, fault);
  ++piece.tally.invalid_points;
}

void append_boundary(Piece& piece, const Row& row, std::span<const options::BoundaryPoint> points) {
  for (const options::BoundaryPoint& point : points) {
    csv::append_field(piece.boundaries, row.id);
    append_next(piece.boundaries, point.time);
    append_next(piece.boundaries, point.spot);
    piece.boundaries += '\n';
  }
}

}  // namespace drogue::options_app
