#include "common/run/fields/xdmf.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace drogue::run {
namespace {

TEST(Xdmf, WritesSixComponentsAsSymmetricTensor) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {3, 3}, "m", "vertex", ""},
                                         {"triangles", {1, 3}, "1", "face", ""},
                                         {"strings", {0, 2}, "1", "edge", ""}};
  const std::string text =
      xdmf_document("c", {{"", mesh, {{"stress", {1, 6}, "N/m", "face", ""}}}}, {{"000000", 0.0}});
  EXPECT_NE(text.find("<Attribute Name=\"stress\" AttributeType=\"Tensor6\" Center=\"Cell\">"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Dimensions=\"1 6\""), std::string::npos) << text;
}

TEST(Xdmf, ListsEveryStepOfALine) {
  const DatasetSpec x = {"x", {3}, "m", "cell", "cell centres"};
  const DatasetSpec rho = {"rho", {3}, "kg/m^3", "cell", "density"};
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="a&lt;b" GridType="Collection" CollectionType="Temporal">
      <Grid Name="a&lt;b" GridType="Uniform">
        <Time Value="0.1"/>
        <Topology TopologyType="3DRectMesh" Dimensions="1 1 3"/>
        <Geometry GeometryType="VXVYVZ">
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/x</DataItem>
          <DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">0</DataItem>
          <DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">0</DataItem>
        </Geometry>
        <Attribute Name="rho" AttributeType="Scalar" Center="Node">
          <DataItem Dimensions="1 1 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/rho</DataItem>
        </Attribute>
      </Grid>
    </Grid>
  </Domain>
</Xdmf>
)";
  EXPECT_EQ(xdmf_document("a<b", {{"", {x}, {rho}}}, {{"000000", 0.1}}), expected);
}

TEST(Xdmf, PlacesTrianglesAtTheFieldPosition) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {4, 3}, "m", "vertex", ""},
                                         {"triangles", {2, 3}, "1", "face", ""},
                                         {"edges", {5, 2}, "1", "edge", ""},
                                         {"strings", {0, 2}, "1", "edge", ""}};
  const DatasetSpec position = {"position", {4, 3}, "m", "vertex", ""},
                    velocity = {"velocity", {4, 3}, "m/s", "vertex", ""},
                    stress = {"von_mises", {2}, "N/m", "face", ""};
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="c" GridType="Collection" CollectionType="Temporal">
      <Grid Name="c" GridType="Uniform">
        <Time Value="0.5"/>
        <Topology TopologyType="Triangle" NumberOfElements="2">
          <DataItem Dimensions="2 3" NumberType="Int" Precision="8" Format="HDF">fields.h5:/mesh/triangles</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">
          <DataItem Dimensions="4 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/position</DataItem>
        </Geometry>
        <Attribute Name="velocity" AttributeType="Vector" Center="Node">
          <DataItem Dimensions="4 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/velocity</DataItem>
        </Attribute>
        <Attribute Name="von_mises" AttributeType="Scalar" Center="Cell">
          <DataItem Dimensions="2" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/von_mises</DataItem>
        </Attribute>
      </Grid>
    </Grid>
  </Domain>
</Xdmf>
)";
  EXPECT_EQ(xdmf_document("c", {{"", mesh, {velocity, position, stress}}}, {{"000000", 0.5}}), expected);
}

TEST(Xdmf, GivesStringsBesideTrianglesTheirOwnGrid) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {5, 3}, "m", "vertex", ""},
                                         {"triangles", {2, 3}, "1", "face", ""},
                                         {"edges", {6, 2}, "1", "edge", ""},
                                         {"strings", {1, 2}, "1", "edge", ""}};
  const DatasetSpec velocity = {"velocity", {5, 3}, "m/s", "vertex", ""},
                    stress = {"von_mises", {2}, "N/m", "face", ""};
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="c triangles" GridType="Collection" CollectionType="Temporal">
      <Grid Name="c triangles" GridType="Uniform">
        <Time Value="0.5"/>
        <Topology TopologyType="Triangle" NumberOfElements="2">
          <DataItem Dimensions="2 3" NumberType="Int" Precision="8" Format="HDF">fields.h5:/mesh/triangles</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">
          <DataItem Dimensions="5 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/vertices</DataItem>
        </Geometry>
        <Attribute Name="velocity" AttributeType="Vector" Center="Node">
          <DataItem Dimensions="5 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/velocity</DataItem>
        </Attribute>
        <Attribute Name="von_mises" AttributeType="Scalar" Center="Cell">
          <DataItem Dimensions="2" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/von_mises</DataItem>
        </Attribute>
      </Grid>
    </Grid>
    <Grid Name="c strings" GridType="Collection" CollectionType="Temporal">
      <Grid Name="c strings" GridType="Uniform">
        <Time Value="0.5"/>
        <Topology TopologyType="Polyline" NodesPerElement="2" NumberOfElements="1">
          <DataItem Dimensions="1 2" NumberType="Int" Precision="8" Format="HDF">fields.h5:/mesh/strings</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">
          <DataItem Dimensions="5 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/vertices</DataItem>
        </Geometry>
        <Attribute Name="velocity" AttributeType="Vector" Center="Node">
          <DataItem Dimensions="5 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/velocity</DataItem>
        </Attribute>
      </Grid>
    </Grid>
  </Domain>
</Xdmf>
)";
  EXPECT_EQ(xdmf_document("c", {{"", mesh, {velocity, stress}}}, {{"000000", 0.5}}), expected);
}

TEST(Xdmf, DrawsStringsAtRestWithoutTrianglesAndPositions) {
  const std::vector<DatasetSpec> mesh = {{"triangles", {0, 3}, "1", "face", ""},
                                         {"strings", {2, 2}, "1", "edge", ""},
                                         {"vertices", {3, 3}, "m", "vertex", ""}};
  const std::string text = xdmf_document("s", {{"", mesh, {}}}, {{"000000", 0.0}});
  EXPECT_NE(text.find(R"(<Topology TopologyType="Polyline" NodesPerElement="2" NumberOfElements="2">)"),
            std::string::npos);
  EXPECT_NE(text.find("fields.h5:/mesh/strings"), std::string::npos);
  EXPECT_NE(text.find("fields.h5:/mesh/vertices"), std::string::npos);
}

TEST(Xdmf, WritesRectilinearCellsOfThreeDimensionsWithXFastest) {
  const std::vector<DatasetSpec> mesh = {
      {"x", {5}, "m", "face", ""}, {"y", {4}, "m", "face", ""}, {"z", {3}, "m", "face", ""}};
  const DatasetSpec pressure = {"pressure", {2, 3, 4}, "Pa", "cell", ""},
                    velocity = {"velocity", {2, 3, 4, 3}, "m/s", "cell", ""};
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="f" GridType="Collection" CollectionType="Temporal">
      <Grid Name="f" GridType="Uniform">
        <Time Value="0.5"/>
        <Topology TopologyType="3DRectMesh" Dimensions="3 4 5"/>
        <Geometry GeometryType="VXVYVZ">
          <DataItem Dimensions="5" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/x</DataItem>
          <DataItem Dimensions="4" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/y</DataItem>
          <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/mesh/z</DataItem>
        </Geometry>
        <Attribute Name="pressure" AttributeType="Scalar" Center="Cell">
          <DataItem Dimensions="2 3 4" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/pressure</DataItem>
        </Attribute>
        <Attribute Name="velocity" AttributeType="Vector" Center="Cell">
          <DataItem Dimensions="2 3 4 3" NumberType="Float" Precision="8" Format="HDF">fields.h5:/steps/000000/velocity</DataItem>
        </Attribute>
      </Grid>
    </Grid>
  </Domain>
</Xdmf>
)";
  EXPECT_EQ(xdmf_document("f", {{"", mesh, {pressure, velocity}}}, {{"000000", 0.5}}), expected);
}

TEST(Xdmf, GivesAPlaneOfCellsALeadingDimensionOfOne) {
  const std::vector<DatasetSpec> mesh = {{"x", {5}, "m", "face", ""}, {"y", {4}, "m", "face", ""}};
  const std::string text = xdmf_document(
      "p", {{"", mesh, {{"u", {3, 4}, "m/s", "cell", ""}, {"v", {3, 4, 3}, "m/s", "cell", ""}}}},
      {{"000000", 0.0}});
  EXPECT_NE(text.find(R"(TopologyType="3DRectMesh" Dimensions="1 4 5")"), std::string::npos) << text;
  EXPECT_NE(text.find("Dimensions=\"1 3 4\""), std::string::npos) << text;
  EXPECT_NE(text.find("Dimensions=\"1 3 4 3\""), std::string::npos) << text;
  EXPECT_NE(text.find("Format=\"XML\">0</DataItem>"), std::string::npos) << text;
}

TEST(Xdmf, WritesAStructuredGridWithPointsInTheOrderOfItsFields) {
  const std::vector<DatasetSpec> mesh = {{"x", {5}, "m", "face", ""},
                                         {"y", {4}, "m", "face", ""},
                                         {"z", {3}, "m", "face", ""},
                                         {"points", {5, 4, 3, 3}, "m", "vertex", ""}};
  const std::string text =
      xdmf_document("s", {{"", mesh, {{"velocity", {4, 3, 2, 3}, "m/s", "cell", ""}}}}, {{"000000", 0.0}});
  EXPECT_NE(text.find(R"(TopologyType="3DSMesh" Dimensions="5 4 3")"), std::string::npos) << text;
  EXPECT_NE(text.find("Dimensions=\"4 3 2 3\""), std::string::npos) << text;
  EXPECT_NE(text.find("AttributeType=\"Vector\" Center=\"Cell\""), std::string::npos) << text;
}

TEST(Xdmf, NamesSeveralGridsAndTheirGroups) {
  const std::vector<DatasetSpec> flow = {{"x", {5}, "m", "face", ""}, {"y", {4}, "m", "face", ""}};
  const std::vector<DatasetSpec> canopy = {{"vertices", {4, 3}, "m", "vertex", "", "canopy"},
                                           {"triangles", {2, 3}, "1", "face", "", "canopy"},
                                           {"strings", {0, 2}, "1", "edge", "", "canopy"}};
  const std::string text =
      xdmf_document("p",
                    {{"", flow, {{"pressure", {3, 4}, "Pa", "cell", ""}}},
                     {"canopy", canopy, {{"position", {4, 3}, "m", "vertex", "", "canopy"}}}},
                    {{"000000", 0.0}, {"000001", 1.0}});
  for (const char* part :
       {"<Grid Name=\"p\" GridType=\"Collection\"", "<Grid Name=\"p canopy\" GridType=\"Collection\"",
        "fields.h5:/mesh/canopy/triangles", "fields.h5:/steps/000001/canopy/position",
        "fields.h5:/steps/000001/pressure"})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
}

TEST(Xdmf, RejectsAnIncompleteMesh) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {4, 3}, "m", "vertex", ""}};
  EXPECT_FALSE(is_complete(mesh));
  EXPECT_THROW(static_cast<void>(xdmf_document("p", {{"", mesh, {}}}, {})), std::invalid_argument);
}

TEST(Xdmf, RejectsFieldsOfARectilinearGridWithZFastest) {
  const std::vector<DatasetSpec> mesh = {
      {"x", {5}, "m", "face", ""}, {"y", {4}, "m", "face", ""}, {"z", {3}, "m", "face", ""}};
  const DatasetSpec velocity = {"velocity", {4, 3, 2, 3}, "m/s", "cell", ""};
  EXPECT_THROW(static_cast<void>(xdmf_document("f", {{"", mesh, {velocity}}}, {{"000000", 0.0}})),
               std::invalid_argument);
}

}  // namespace
}  // namespace drogue::run
