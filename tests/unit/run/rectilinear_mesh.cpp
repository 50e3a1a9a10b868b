#include "common/run/fields/rectilinear_mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <regex>

#include "common/run/fields/fields_writer.hpp"
#include "common/run/hdf5/hdf5.hpp"
#include "tests/unit/run/temporary_directory.hpp"

// Reads fields.xdmf back as ParaView does: the last dimension of a DataItem varies fastest, and the fastest
// index of a 3DRectMesh runs along x. Vertices of a 3DSMesh are explicit.

namespace drogue::run {
namespace {

using test::content;
using test::TemporaryDirectory;

const FaceCoordinates faces = {
    {0.0, 1.0, 3.0, 6.0, 10.0}, {-1.0, -0.5, 0.5, 2.0}, {5.0, 5.25, 6.0}};  // 4 x 3 x 2 cells

using Vector = std::array<double, 3>;

/// Velocity at a point, m/s; each component differs from point to point.
Vector velocity(const Vector& at) {
  return {at[0] + 100.0 * at[1], at[1] + 100.0 * at[2], at[2] + 100.0 * at[0]};
}

double pressure(const Vector& at) { return at[0] + 10.0 * at[1] + 1000.0 * at[2]; }

Vector centre(std::size_t i, std::size_t j, std::size_t k) {
  return {0.5 * (faces.x[i] + faces.x[i + 1]), 0.5 * (faces.y[j] + faces.y[j + 1]),
          0.5 * (faces.z[k] + faces.z[k + 1])};
}

/// Writes one output with the fields of all cells, in the given order of axes.
void write_fields(const TemporaryDirectory& directory, AxisOrder order) {
  const bool is_xyz = order == AxisOrder::xyz;
  const std::size_t nx = faces.x.size() - 1, ny = faces.y.size() - 1, nz = faces.z.size() - 1;
  std::vector<std::uint64_t> shape = {nz, ny, nx};
  if (is_xyz) shape = {nx, ny, nz};
  std::vector<double> p, v;
  for (std::size_t a = 0; a < shape[0]; ++a)
    for (std::size_t b = 0; b < shape[1]; ++b)
      for (std::size_t c = 0; c < shape[2]; ++c) {
        const Vector at = is_xyz ? centre(a, b, c) : centre(c, b, a);
        p.push_back(pressure(at));
        for (const double component : velocity(at)) v.push_back(component);
      }
  std::vector<std::uint64_t> vector_shape = shape;
  vector_shape.push_back(3);
  FieldsWriter fields(directory.path(), "flow",
                      {{"pressure", shape, "Pa", "cell", ""}, {"velocity", vector_shape, "m/s", "cell", ""}});
  add_rectilinear_mesh(fields, faces, order);
  fields.begin_step(0.0, 0);
  fields.write("pressure", 0, p);
  fields.write("velocity", 0, v);
  fields.end_step();
}

/// First group of the expression in the text.
std::string match(const std::string& text, const std::string& expression) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex(expression))) throw std::runtime_error(expression);
  return found[1];
}

std::vector<std::size_t> numbers(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::size_t>(stream), {}};
}

/// The values of the data item behind `place` in the document, and its dimensions.
struct DataItem {
  std::vector<std::size_t> dimensions;
  std::vector<double> values;

  DataItem(const TemporaryDirectory& directory, const std::string& xml, const std::string& place)
      : dimensions(numbers(match(xml, place + "[\\s\\S]*?<DataItem Dimensions=\"([\\d ]+)\""))) {
    const std::string path = match(xml, place + R"([\s\S]*?<DataItem[^>]*>fields\.h5:/([^<]+)<)");
    std::size_t size = 1;
    for (const std::size_t n : dimensions) size *= n;
    values.resize(size);
    const h5::Handle file = h5::open_file(directory / "fields.h5", false);
    h5::read(h5::open_dataset(file, path), 0, values);
  }
};

/// Vertices in the linear order of the topology.
std::vector<Vector> vertices(const TemporaryDirectory& directory, const std::string& xml,
                             const std::vector<std::size_t>& points) {
  std::vector<Vector> all;
  if (match(xml, "TopologyType=\"(\\w+)\"") == "3DSMesh") {
    const DataItem item(directory, xml, "GeometryType=\"XYZ\"");
    for (std::size_t n = 0; n < item.values.size(); n += 3)
      all.push_back({item.values[n], item.values[n + 1], item.values[n + 2]});
    return all;
  }
  const std::string item = R"([\s\S]*?</DataItem>)", vectors = "GeometryType=\"VXVYVZ\"";
  const DataItem x(directory, xml, vectors), y(directory, xml, vectors + item),
      z(directory, xml, vectors + item + item);
  for (std::size_t k = 0; k < points[0]; ++k)
    for (std::size_t j = 0; j < points[1]; ++j)
      for (std::size_t i = 0; i < points[2]; ++i) all.push_back({x.values[i], y.values[j], z.values[k]});
  return all;
}

/// Expects every value of the file at the centre of the cell that fields.xdmf assigns to it.
void expect_values_at_their_coordinates(const TemporaryDirectory& directory) {
  const std::string xml = content(directory / "fields.xdmf");
  const std::vector<std::size_t> points = numbers(match(xml, "<Topology[^>]*Dimensions=\"([\\d ]+)\""));
  ASSERT_EQ(points.size(), 3U);
  const std::vector<Vector> at = vertices(directory, xml, points);
  ASSERT_EQ(at.size(), points[0] * points[1] * points[2]);
  const DataItem p(directory, xml, "Attribute Name=\"pressure\""),
      v(directory, xml, "Attribute Name=\"velocity\"");
  EXPECT_EQ(p.dimensions, (std::vector<std::size_t>{points[0] - 1, points[1] - 1, points[2] - 1}));
  EXPECT_EQ(v.dimensions, (std::vector<std::size_t>{points[0] - 1, points[1] - 1, points[2] - 1, 3}));
  EXPECT_EQ(match(xml, "Attribute Name=\"velocity\" AttributeType=\"(\\w+)\""), "Vector");
  std::size_t cell = 0;
  for (std::size_t a = 0; a + 1 < points[0]; ++a)
    for (std::size_t b = 0; b + 1 < points[1]; ++b)
      for (std::size_t c = 0; c + 1 < points[2]; ++c, ++cell) {
        const std::size_t first = (a * points[1] + b) * points[2] + c;
        const std::size_t opposite = first + (points[1] + 1) * points[2] + 1;
        Vector middle;
        for (std::size_t axis = 0; axis < 3; ++axis)
          middle[axis] = 0.5 * (at[first][axis] + at[opposite][axis]);
        EXPECT_EQ(p.values[cell], pressure(middle)) << "cell " << a << " " << b << " " << c;
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_EQ(v.values[3 * cell + axis], velocity(middle)[axis])
              << "cell " << a << " " << b << " " << c;
      }
  EXPECT_EQ(cell, 24U);
}

TEST(RectilinearMesh, PlacesFieldsWithXFastestAtTheirCoordinates) {
  const TemporaryDirectory directory;
  write_fields(directory, AxisOrder::zyx);
  expect_values_at_their_coordinates(directory);
}

TEST(RectilinearMesh, PlacesFieldsWithZFastestAtTheirCoordinates) {
  const TemporaryDirectory directory;
  write_fields(directory, AxisOrder::xyz);
  expect_values_at_their_coordinates(directory);
  const h5::Handle file = h5::open_file(directory / "fields.h5", false);
  EXPECT_EQ(h5::shape(h5::open_dataset(file, "steps/000000/velocity")),
            (std::vector<std::uint64_t>{4, 3, 2, 3}));
}

TEST(RectilinearMesh, RejectsAnAxisWithOneCoordinate) {
  const TemporaryDirectory directory;
  FieldsWriter fields(directory.path(), "flow", {{"pressure", {1, 1, 1}, "Pa", "cell", ""}});
  EXPECT_THROW(add_rectilinear_mesh(fields, {{0.0, 1.0}, {0.0, 1.0}, {0.0}}, AxisOrder::zyx),
               std::invalid_argument);
}

}  // namespace
}  // namespace drogue::run
