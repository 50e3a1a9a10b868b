#include "common/run/xdmf.hpp"

#include <charconv>
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
std::string dimensions(const DatasetSpec& spec) {
  std::string text;
  for (const std::uint64_t n : spec.shape) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

std::string time_of(const OutputStep& output) {
  return R"(        <Time Value=")" + shortest(output.time) + "\"/>\n";
}

/// A rectilinear grid of n x 1 x 1 points: the one kind of line that all versions of ParaView's reader know.
std::string grid(const std::string& title, const DatasetSpec& x, const std::vector<DatasetSpec>& fields,
                 const OutputStep& output) {
  const std::string points = std::to_string(x.shape.at(0));
  const std::string zero =
      R"(<DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">0</DataItem>)";
  std::string text = R"(      <Grid Name=")" + escaped(title) + "\" GridType=\"Uniform\">\n";
  text += time_of(output);
  text += R"(        <Topology TopologyType="3DRectMesh" Dimensions="1 1 )" + points + "\"/>\n";
  text += "        <Geometry GeometryType=\"VXVYVZ\">\n          " + hdf_item(points, "/mesh/" + x.name);
  text += "          " + zero + "\n          " + zero + "\n        </Geometry>\n";
  for (const DatasetSpec& field : fields) {
    text += R"(        <Attribute Name=")" + escaped(field.name) +
            "\" AttributeType=\"Scalar\" Center=\"Node\">\n          ";
    text += hdf_item("1 1 " + points, "/steps/" + output.group + "/" + field.name) + "        </Attribute>\n";
  }
  return text + "      </Grid>\n";
}

/// One mesh at all times.
std::string series(const std::string& name, const std::string& grids) {
  return R"(    <Grid Name=")" + escaped(name) + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
         grids + "    </Grid>\n";
}

std::string document(const std::string& meshes) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n" + meshes +
         "  </Domain>\n</Xdmf>\n";
}

const DatasetSpec* find(const std::vector<DatasetSpec>& specs, std::string_view name) {
  for (const DatasetSpec& spec : specs)
    if (spec.name == name) return &spec;
  return nullptr;
}

std::string topology(const DatasetSpec& cells) {
  const std::string kind = cells.shape.at(1) == 3 ? "Triangle\"" : "Polyline\" NodesPerElement=\"2\"";
  return R"(        <Topology TopologyType=")" + kind + " NumberOfElements=\"" +
         std::to_string(cells.shape.at(0)) + "\">\n          " +
         hdf_item(dimensions(cells), "/mesh/" + cells.name, "Int") + "        </Topology>\n";
}

std::string attribute(const DatasetSpec& field, const std::string& place) {
  const std::string type = field.shape.size() < 2 ? "Scalar" : field.shape[1] == 6 ? "Tensor6" : "Vector";
  const std::string centre = field.centering == "vertex" ? "Node" : "Cell";
  return R"(        <Attribute Name=")" + escaped(field.name) + R"(" AttributeType=")" + type +
         R"(" Center=")" + centre + "\">\n          " + hdf_item(dimensions(field), place + field.name) +
         "        </Attribute>\n";
}

/// `cells` at one time, with the fields at their vertices and their own.
std::string cloth_grid(const std::string& name, const DatasetSpec& cells, const DatasetSpec& vertices,
                       const std::vector<DatasetSpec>& fields, const OutputStep& output) {
  const DatasetSpec* moved = find(fields, "position");
  const std::string place = "/steps/" + output.group + "/";
  std::string text = R"(      <Grid Name=")" + escaped(name) + "\" GridType=\"Uniform\">\n";
  text += time_of(output) + topology(cells);
  text += "        <Geometry GeometryType=\"XYZ\">\n          " +
          (moved != nullptr ? hdf_item(dimensions(*moved), place + moved->name)
                            : hdf_item(dimensions(vertices), "/mesh/" + vertices.name)) +
          "        </Geometry>\n";
  for (const DatasetSpec& field : fields)
    if (&field != moved && (field.centering == "vertex" || field.centering == cells.centering))
      text += attribute(field, place);
  return text + "      </Grid>\n";
}

}  // namespace

std::string xdmf_cloth_document(const std::string& title, const std::vector<DatasetSpec>& mesh,
                                const std::vector<DatasetSpec>& fields,
                                const std::vector<OutputStep>& outputs) {
  const DatasetSpec& vertices = *find(mesh, "vertices");
  const auto series_of = [&](const std::string& name, const DatasetSpec& cells) {
    std::string grids;
    for (const OutputStep& output : outputs) grids += cloth_grid(name, cells, vertices, fields, output);
    return series(name, grids);
  };
  const DatasetSpec &triangles = *find(mesh, "triangles"), &strings = *find(mesh, "strings");
  if (strings.shape.at(0) == 0) return document(series_of(title, triangles));
  if (triangles.shape.at(0) == 0) return document(series_of(title, strings));
  return document(series_of(title + " cloth", triangles) + series_of(title + " strings", strings));
}

std::string xdmf_document(const std::string& title, const DatasetSpec& x,
                          const std::vector<DatasetSpec>& fields, const std::vector<OutputStep>& outputs) {
  std::string grids;
  for (const OutputStep& output : outputs) grids += grid(title, x, fields, output);
  return document(series(title, grids));
}

}  // namespace drogue::run
