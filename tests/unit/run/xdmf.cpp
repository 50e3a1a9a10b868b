#include "common/run/xdmf.hpp"

#include <gtest/gtest.h>

namespace drogue::run {
namespace {

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

}  // namespace
}  // namespace drogue::run
