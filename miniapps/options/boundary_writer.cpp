#include "miniapps/options/boundary_writer.hpp"

#include "common/csv/fields.hpp"
#include "common/csv/numbers.hpp"

namespace drogue::options_app {

BoundaryWriter::BoundaryWriter(const std::filesystem::path& file) : _file(file) {
  _file.write("id,time,spot\n");
}

void BoundaryWriter::write(const std::string& id, std::span<const options::BoundaryPoint> points) {
  for (const options::BoundaryPoint& point : points) {
    csv::append_field(_text, id);
    _text += ',';
    csv::append_number(_text, point.time);
    _text += ',';
    csv::append_number(_text, point.spot);
    _text += '\n';
  }
  _file.write(_text);
  _text.clear();
}

void BoundaryWriter::commit() { _file.commit(); }

}  // namespace drogue::options_app
