#include "common/run/xdmf.hpp"

#include <gtest/gtest.h>

namespace drogue::run {
namespace {

TEST(Xdmf, SixComponentsAreASymmetricTensor) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {3, 3}, "m", "vertex", ""},
                                         {"triangles", {1, 3}, "1", "face", ""},
                                         {"strings", {0, 2}, "1", "edge", ""}};
  const std::string text =
      xdmf_cloth_document("c", mesh, {{"stress", {1, 6}, "N/m", "face", ""}}, {{"000000", 0.0}});
  EXPECT_NE(text.find("<Attribute Name=\"stress\" AttributeType=\"Tensor6\" Center=\"Cell\">"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Dimensions=\"1 6\""), std::string::npos) << text;
}

TEST(Xdmf, ListsEveryStepOverTheLine) {
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
  EXPECT_EQ(xdmf_document("a<b", x, {rho}, {{"000000", 0.1}}), expected);
}

TEST(Xdmf, ClothMovesWithItsPositions) {
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
  EXPECT_EQ(xdmf_cloth_document("c", mesh, {velocity, position, stress}, {{"000000", 0.5}}), expected);
}

TEST(Xdmf, StringsBesideClothAreAMeshOfTheirOwn) {
  const std::vector<DatasetSpec> mesh = {{"vertices", {5, 3}, "m", "vertex", ""},
                                         {"triangles", {2, 3}, "1", "face", ""},
                                         {"edges", {6, 2}, "1", "edge", ""},
                                         {"strings", {1, 2}, "1", "edge", ""}};
  const DatasetSpec velocity = {"velocity", {5, 3}, "m/s", "vertex", ""},
                    stress = {"von_mises", {2}, "N/m", "face", ""};
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="c cloth" GridType="Collection" CollectionType="Temporal">
      <Grid Name="c cloth" GridType="Uniform">
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
  EXPECT_EQ(xdmf_cloth_document("c", mesh, {velocity, stress}, {{"000000", 0.5}}), expected);
}

TEST(Xdmf, WithoutTrianglesStringsAreDrawnAndWithoutPositionsTheyStay) {
  const std::vector<DatasetSpec> mesh = {{"triangles", {0, 3}, "1", "face", ""},
                                         {"strings", {2, 2}, "1", "edge", ""},
                                         {"vertices", {3, 3}, "m", "vertex", ""}};
  const std::string text = xdmf_cloth_document("s", mesh, {}, {{"000000", 0.0}});
  EXPECT_NE(text.find(R"(<Topology TopologyType="Polyline" NodesPerElement="2" NumberOfElements="2">)"),
            std::string::npos);
  EXPECT_NE(text.find("fields.h5:/mesh/strings"), std::string::npos);
  EXPECT_NE(text.find("fields.h5:/mesh/vertices"), std::string::npos);
}

}  // namespace
}  // namespace drogue::run
