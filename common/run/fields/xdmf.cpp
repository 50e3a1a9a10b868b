#include "common/run/fields/xdmf.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

namespace drogue::run {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string shortest(double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  return {digits, end};
}

std::string hdf_item(const std::string& dimensions, const std::string& dataset,
                     const std::string& type = "Float") {
  return R"(<DataItem Dimensions=")" + dimensions + R"(" NumberType=")" + type +
         R"(" Precision="8" Format="HDF">fields.h5:)" + escaped(dataset) + "</DataItem>\n";
}

/// `(3, 2)` as `3 2`.
std::string dimensions(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t n : shape) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

const DatasetSpec* find(const std::vector<DatasetSpec>& specs, std::string_view name) {
  const auto found = std::ranges::find(specs, name, &DatasetSpec::name);
  return found == specs.end() ? nullptr : &*found;
}

const DatasetSpec& at(const std::vector<DatasetSpec>& specs, std::string_view name) {
  if (const DatasetSpec* found = find(specs, name)) return *found;
  throw std::invalid_argument("the grid has no mesh dataset " + std::string(name));
}

bool is_rectilinear(const std::vector<DatasetSpec>& mesh) {
  const DatasetSpec *x = find(mesh, "x"), *y = find(mesh, "y");
  return x != nullptr && y != nullptr && x->centering == "face" && y->centering == "face";
}

/// True if the leading dimensions of a field are the cells or vertices of a rectilinear grid along (z,) y and
/// x.
bool has_rectilinear_shape(const DatasetSpec& field, const std::vector<DatasetSpec>& mesh) {
  const std::uint64_t at_cells = field.centering == "vertex" ? 0 : 1;
  std::vector<std::uint64_t> expected;
  for (const char* axis : {"z", "y", "x"})
    if (const DatasetSpec* faces = find(mesh, axis)) expected.push_back(faces->shape.at(0) - at_cells);
  return field.shape.size() >= expected.size() &&
         std::equal(expected.begin(), expected.end(), field.shape.begin());
}

/// Grid at one output time.
class GridAtTime {
 public:
  GridAtTime(const GridDatasets& grid, const OutputStep& output)
      : _grid(grid), _output(output), _group(grid.name.empty() ? "" : grid.name + "/") {}

  /// A rectilinear grid of n x 1 x 1 points: the one kind of line that all versions of ParaView read.
  [[nodiscard]] std::string line(const std::string& name) const {
    const DatasetSpec& x = at(_grid.mesh, "x");
    const std::string points = std::to_string(x.shape.at(0));
    std::string content =
        R"(        <Topology TopologyType="3DRectMesh" Dimensions="1 1 )" + points + "\"/>\n";
    content += geometry("VXVYVZ", mesh_item(x) + zero() + zero());
    for (const DatasetSpec& field : _grid.fields)
      content += attribute(field, "Scalar", "Node", "1 1 " + points);
    return grid(name, content);
  }

  /// Cells between face coordinates; without z one plane of cells at z = 0.
  [[nodiscard]] std::string rectilinear(const std::string& name) const {
    const DatasetSpec &x = at(_grid.mesh, "x"), &y = at(_grid.mesh, "y");
    const DatasetSpec* z = find(_grid.mesh, "z");
    std::vector<std::uint64_t> faces = {y.shape.at(0), x.shape.at(0)};
    faces.insert(faces.begin(), z != nullptr ? z->shape.at(0) : 1);
    std::string content =
        R"(        <Topology TopologyType="3DRectMesh" Dimensions=")" + dimensions(faces) + "\"/>\n";
    content += geometry("VXVYVZ", mesh_item(x) + mesh_item(y) + (z != nullptr ? mesh_item(*z) : zero()));
    for (const DatasetSpec& field : _grid.fields) {
      if (!has_rectilinear_shape(field, _grid.mesh))
        throw std::invalid_argument("the field '" + field.name + "' of shape " + dimensions(field.shape) +
                                    " does not fit a rectilinear grid of " + dimensions(faces) +
                                    " faces along z, y and x; add the mesh dataset 'points' for fields with "
                                    "another order of the axes");
      content += structured_attribute(field, z == nullptr);
    }
    return grid(name, content);
  }

  /// A structured grid with explicit vertices, in any index order.
  [[nodiscard]] std::string structured(const std::string& name) const {
    const DatasetSpec& points = at(_grid.mesh, "points");
    const std::vector<std::uint64_t>& n = points.shape;
    std::string content = R"(        <Topology TopologyType="3DSMesh" Dimensions=")" +
                          dimensions({n.at(0), n.at(1), n.at(2)}) + "\"/>\n";
    content += geometry("XYZ", mesh_item(points));
    for (const DatasetSpec& field : _grid.fields) content += structured_attribute(field, false);
    return grid(name, content);
  }

  /// Triangles or strings with the fields at their vertices and cells.
  [[nodiscard]] std::string elements(const std::string& name, const DatasetSpec& cells) const {
    const DatasetSpec* moved = find(_grid.fields, "position");
    const std::string kind = cells.shape.at(1) == 3 ? "Triangle\"" : "Polyline\" NodesPerElement=\"2\"";
    std::string content = R"(        <Topology TopologyType=")" + kind + " NumberOfElements=\"" +
                          std::to_string(cells.shape.at(0)) + "\">\n" + mesh_item(cells, "Int") +
                          "        </Topology>\n";
    content += geometry("XYZ", moved != nullptr ? field_item(*moved, dimensions(moved->shape))
                                                : mesh_item(at(_grid.mesh, "vertices")));
    for (const DatasetSpec& field : _grid.fields) {
      const bool at_vertices = field.centering == "vertex";
      if (&field == moved || (!at_vertices && field.centering != cells.centering)) continue;
      const std::string type = field.shape.size() < 2 ? "Scalar" : type_of(field.shape[1]);
      content += attribute(field, type, at_vertices ? "Node" : "Cell", dimensions(field.shape));
    }
    return grid(name, content);
  }

 private:
  static std::string type_of(std::uint64_t components) {
    return components == 6 ? "Tensor6" : components == 3 ? "Vector" : "Scalar";
  }

  static std::string zero() {
    return "          <DataItem Dimensions=\"1\" NumberType=\"Float\" Precision=\"8\" "
           "Format=\"XML\">0</DataItem>\n";
  }

  [[nodiscard]] std::string mesh_item(const DatasetSpec& spec, const std::string& type = "Float") const {
    return "          " + hdf_item(dimensions(spec.shape), "/mesh/" + _group + spec.name, type);
  }

  [[nodiscard]] std::string field_item(const DatasetSpec& field, const std::string& shape) const {
    return "          " + hdf_item(shape, "/steps/" + _output.group + "/" + _group + field.name);
  }

  static std::string geometry(const std::string& type, const std::string& items) {
    return "        <Geometry GeometryType=\"" + type + "\">\n" + items + "        </Geometry>\n";
  }

  [[nodiscard]] std::string attribute(const DatasetSpec& field, const std::string& type,
                                      const std::string& centre, const std::string& shape) const {
    return R"(        <Attribute Name=")" + escaped(field.name) + R"(" AttributeType=")" + type +
           R"(" Center=")" + centre + "\">\n" + field_item(field, shape) + "        </Attribute>\n";
  }

  /// ParaView expects three dimensions, and those of the components behind them.
  [[nodiscard]] std::string structured_attribute(const DatasetSpec& field, bool is_planar) const {
    std::vector<std::uint64_t> shape = field.shape;
    const std::size_t axes = is_planar ? 2 : 3;
    const std::string type = shape.size() > axes ? type_of(shape.back()) : "Scalar";
    if (is_planar) shape.insert(shape.begin(), 1);
    return attribute(field, type, field.centering == "vertex" ? "Node" : "Cell", dimensions(shape));
  }

  [[nodiscard]] std::string grid(const std::string& name, const std::string& content) const {
    return R"(      <Grid Name=")" + escaped(name) + "\" GridType=\"Uniform\">\n        <Time Value=\"" +
           shortest(_output.time) + "\"/>\n" + content + "      </Grid>\n";
  }

  const GridDatasets& _grid;
  const OutputStep& _output;
  std::string _group;
};

/// Temporal collection of a grid; `at_time` writes the grid at one output time.
template <class AtTime>
std::string collection(const std::string& name, const GridDatasets& grid,
                       const std::vector<OutputStep>& outputs, const AtTime& at_time) {
  std::string text =
      R"(    <Grid Name=")" + escaped(name) + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const OutputStep& output : outputs) text += at_time(GridAtTime(grid, output));
  return text + "    </Grid>\n";
}

std::string collections(const std::string& title, const GridDatasets& grid,
                        const std::vector<OutputStep>& outputs) {
  const std::string name = title + (grid.name.empty() ? "" : " " + grid.name);
  if (find(grid.mesh, "points") != nullptr)
    return collection(name, grid, outputs, [&](const GridAtTime& now) { return now.structured(name); });
  if (is_rectilinear(grid.mesh))
    return collection(name, grid, outputs, [&](const GridAtTime& now) { return now.rectilinear(name); });
  if (find(grid.mesh, "x") != nullptr)
    return collection(name, grid, outputs, [&](const GridAtTime& now) { return now.line(name); });
  const DatasetSpec &triangles = at(grid.mesh, "triangles"), &strings = at(grid.mesh, "strings");
  const auto of = [&](const std::string& part, const DatasetSpec& cells) {
    return collection(part, grid, outputs, [&](const GridAtTime& now) { return now.elements(part, cells); });
  };
  if (strings.shape.at(0) == 0) return of(name, triangles);
  if (triangles.shape.at(0) == 0) return of(name, strings);
  return of(name + " triangles", triangles) + of(name + " strings", strings);
}

}  // namespace

bool is_complete(const std::vector<DatasetSpec>& mesh) {
  const auto holds = [&](const char* name) { return find(mesh, name) != nullptr; };
  if (const DatasetSpec* x = find(mesh, "x"); x != nullptr && x->centering == "face") return holds("y");
  return holds("points") || holds("x") || (holds("vertices") && holds("triangles") && holds("strings"));
}

bool fields_fit(const GridDatasets& grid) {
  if (find(grid.mesh, "points") != nullptr || !is_rectilinear(grid.mesh)) return true;
  return std::ranges::all_of(
      grid.fields, [&](const DatasetSpec& field) { return has_rectilinear_shape(field, grid.mesh); });
}

std::string xdmf_document(const std::string& title, const std::vector<GridDatasets>& grids,
                          const std::vector<OutputStep>& outputs) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
  for (const GridDatasets& grid : grids) text += collections(title, grid, outputs);
  return text + "  </Domain>\n</Xdmf>\n";
}

}  // namespace drogue::run
