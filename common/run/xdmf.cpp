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

std::string hdf_item(const std::string& dimensions, const std::string& dataset) {
  return R"(<DataItem Dimensions=")" + dimensions +
         R"(" NumberType="Float" Precision="8" Format="HDF">fields.h5:)" + escaped(dataset) + "</DataItem>\n";
}

/// A rectilinear grid of n x 1 x 1 points: the one kind of line that all versions of ParaView's reader know.
std::string grid(const std::string& title, const DatasetSpec& x, const std::vector<DatasetSpec>& fields,
                 const OutputStep& output) {
  const std::string points = std::to_string(x.shape.at(0));
  const std::string zero =
      R"(<DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">0</DataItem>)";
  std::string text = R"(      <Grid Name=")" + escaped(title) + "\" GridType=\"Uniform\">\n";
  text += R"(        <Time Value=")" + shortest(output.time) + "\"/>\n";
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

}  // namespace

std::string xdmf_document(const std::string& title, const DatasetSpec& x,
                          const std::vector<DatasetSpec>& fields, const std::vector<OutputStep>& outputs) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
  text +=
      R"(    <Grid Name=")" + escaped(title) + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const OutputStep& output : outputs) text += grid(title, x, fields, output);
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace drogue::run
