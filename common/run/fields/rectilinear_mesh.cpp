#include "common/run/fields/rectilinear_mesh.hpp"

#include <stdexcept>

namespace drogue::run {
namespace {

void add_points(FieldSink& fields, const FaceCoordinates& faces, const std::string& grid) {
  const DatasetSpec points = {"points", {faces.x.size(), faces.y.size(), faces.z.size(), 3}, "m",
                              "vertex", "vertices in the order of the fields, z fastest",    grid};
  fields.add_mesh(points, [&](std::uint64_t first, std::span<double> values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::size_t entry = first + k, vertex = entry / 3, row = vertex / faces.z.size();
      const double position[] = {faces.x[row / faces.y.size()], faces.y[row % faces.y.size()],
                                 faces.z[vertex % faces.z.size()]};
      values[k] = position[entry % 3];
    }
  });
}

}  // namespace

void add_rectilinear_mesh(FieldSink& fields, const FaceCoordinates& faces, AxisOrder order,
                          const std::string& grid) {
  if (faces.x.size() < 2 || faces.y.size() < 2 || faces.z.size() < 2)
    throw std::invalid_argument("a rectilinear grid needs at least two face coordinates along each axis");
  if (order == AxisOrder::xyz) add_points(fields, faces, grid);
  const auto add = [&](const char* name, const std::vector<double>& values) {
    fields.add_mesh({name, {values.size()}, "m", "face", std::string("face coordinates along ") + name, grid},
                    values);
  };
  add("x", faces.x);
  add("y", faces.y);
  add("z", faces.z);
}

}  // namespace drogue::run
