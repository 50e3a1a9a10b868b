#include "miniapps/options/price_writer.hpp"

#include <limits>

#include "common/csv/fields.hpp"
#include "common/csv/numbers.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t block = std::size_t{1} << 20;

const char* status(options::Outcome outcome) {
  switch (outcome) {
    case options::Outcome::ok:
      return "ok";
    case options::Outcome::coarse:
      return "coarse";
    case options::Outcome::failed:
      return "failed";
  }
  return "failed";
}

}  // namespace

PriceWriter::PriceWriter(const std::filesystem::path& file, Layout layout) : _file(file), _layout(layout) {
  _text.reserve(2 * block);
  _text = layout.surface ? "id,strike,maturity," : "id,";
  _text += "price,error,delta,gamma,theta,exercise_boundary,mesh,steps,status,message\n";
}

void PriceWriter::write(const Row& row, const options::Contract& contract, const options::Price& price) {
  const bool failed = price.outcome == options::Outcome::failed;
  csv::append_field(_text, row.id);
  const auto number = [this](double value) {
    _text += ',';
    csv::append_number(_text, value);
  };
  if (_layout.surface) {
    number(contract.strike);
    number(contract.maturity);
  }
  if (failed) {
    _text += ",,,,,,,,";
  } else {
    number(price.price);
    number(price.error);
    for (const double greek : {price.delta, price.gamma, price.theta})
      number(_layout.greeks ? greek : std::numeric_limits<double>::quiet_NaN());
    number(price.exercise_boundary);
    _text += ',' + std::to_string(price.mesh) + ',' + std::to_string(price.steps);
  }
  _text += ',';
  _text += status(price.outcome);
  _text += failed ? ",a number that is not finite came up" : ",";
  ++_tally.rows;
  if (price.outcome == options::Outcome::coarse) ++_tally.coarse;
  if (failed && _tally.failed++ == 0) _tally.failed_line = row.line;
  end_row();
}

void PriceWriter::write_invalid(const Row& row) {
  csv::append_field(_text, row.id);
  _text += _layout.surface ? ",,,,,,,,,,,invalid," : ",,,,,,,,,invalid,";
  csv::append_field(_text, row.fault);
  ++_tally.rows;
  if (_tally.invalid++ == 0) {
    _tally.invalid_line = row.line;
    _tally.invalid_fault = row.fault;
  }
  end_row();
}

void PriceWriter::end_row() {
  _text += '\n';
  if (_text.size() < block) return;
  _file.write(_text);
  _text.clear();
}

void PriceWriter::commit() {
  _file.write(_text);
  _text.clear();
  _file.commit();
}

}  // namespace drogue::options_app
