#include <gtest/gtest.h>

#include "common/scene/document.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/parse.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "tests/support/refusal.hpp"

namespace drogue::scene {
namespace {

enum class Shape { disk, string };

struct Pin {
  std::string where;
  std::string motion = "0";
  std::vector<double> axes = {1.0, 0.0, 0.0};
};

struct Disk {
  double radius = 0.0;
};

/// Scene of another program: arrays of tables, alternatives, numbers that may be expressions.
struct Fabric {
  bool tension_only = false;
  int count = 3;
  std::int64_t seed = 1;
  std::optional<double> stiffness;
  Shape shape = Shape::disk;
  std::optional<Disk> disk;
  std::optional<Disk> ring;
  std::vector<Pin> pins;
  std::string pressure = "1.0";
  double low = 0.0;
  double high = 1.0;
};

void declare(Table& root, Fabric& cloth) {
  root.value("app", fixed_codec("cloth"), "Program", {.required = true, .decisive = true});
  root.table("mesh",
             [&](Table& mesh) {
               mesh.exactly_one_of({"disk", "ring"});
               const auto disk = [](Table& table, Disk& value) {
                 table.value("radius", value.radius, "Radius",
                             {.unit = "m", .range = positive, .required = true});
               };
               mesh.optional_table("disk", cloth.disk, disk, "A disk");
               mesh.optional_table("ring", cloth.ring, disk, "A ring");
             },
             "Mesh", {.required = true});
  root.table(
      "material",
      [&](Table& material) {
        const Choices<Shape> shapes = {{"disk", Shape::disk}, {"string", Shape::string}};
        const ChoiceKey shape("shape", cloth.shape, shapes);
        material.value(shape, "Shape");
        material.value("tension_only", cloth.tension_only, "No pushing", {.when = shape.is({Shape::string})});
        material.value("stiffness", cloth.stiffness, "Stiffness", {.unit = "N/m", .range = not_negative});
        material.value("count", cloth.count, "Count", {.range = between(1, 10)});
        material.value("seed", cloth.seed, "Seed");
        material.value("pressure", real_or_expression_codec(cloth.pressure, {"x", "t"}), "Pressure",
                       {.unit = "Pa"});
        material.value("interval", interval_codec(cloth.low, cloth.high), "Ends");
        material.former("hardness", "stiffness, in N/m");
      },
      "Material");
  root.tables(
      "pin", cloth.pins,
      [](Table& pin, Pin& value) {
        pin.value("where", expression_codec(value.where, {"x", "y"}), "Place", {.required = true});
        pin.value("motion", real_or_expression_codec(value.motion, {"t"}), "Motion", {.unit = "m"});
        pin.value("axes", reals_codec(value.axes, 3, false), "Axes");
      },
      "Pins");
}

const std::string head = "app = \"cloth\"\n[mesh]\ndisk = { radius = 1 }\n";

Fabric read_cloth(const std::string& text, const std::vector<std::string>& sets = {}) {
  Node document = parse_text(text, "c.toml");
  for (const auto& set : sets) apply_set(document, set);
  Fabric cloth;
  Table root;
  declare(root, cloth);
  read(root, document);
  return cloth;
}

std::string print_cloth(Fabric cloth) {
  Table root;
  declare(root, cloth);
  return print(root);
}

std::string error_of(const std::string& text, const std::vector<std::string>& sets = {}) {
  return testing::refusal_of([&] { return read_cloth(text, sets); });
}

TEST(Schema, ReadsEveryType) {
  const Fabric cloth =
      read_cloth(head +
                 "[material]\nshape = \"string\"\ntension_only = true\nstiffness = 2\ncount = 7\nseed = -5\n"
                 "pressure = \"x*t\"\ninterval = [-1, 2.5]\n"
                 "[[pin]]\nwhere = \"x > 1\"\nmotion = 0.5\n[[pin]]\nwhere = \"y\"\naxes = [0, 1, 2]\n");
  EXPECT_EQ(cloth.disk->radius, 1.0);
  EXPECT_EQ(cloth.shape, Shape::string);
  EXPECT_TRUE(cloth.tension_only);
  EXPECT_EQ(cloth.stiffness, 2.0);
  EXPECT_EQ(cloth.count, 7);
  EXPECT_EQ(cloth.seed, -5);
  EXPECT_EQ(cloth.pressure, "x*t");
  EXPECT_EQ(cloth.high, 2.5);
  ASSERT_EQ(cloth.pins.size(), 2U);
  EXPECT_EQ(cloth.pins[0].motion, "0.5");
  EXPECT_EQ(cloth.pins[1].axes[2], 2.0);
}

TEST(Schema, PrintedSceneReadsBackEqual) {
  const std::string printed = print_cloth(
      read_cloth(head + "[[pin]]\nwhere = \"x > 1\"\n[[pin]]\nwhere = \"y\"\nmotion = \"sin(t)\"\n",
                 {"material.seed=8"}));
  EXPECT_EQ(print_cloth(read_cloth(printed)), printed);
  EXPECT_NE(printed.find("[[pin]]\nwhere = \"x > 1\"\nmotion = \"0\"\naxes = [1.0, 0.0, 0.0]\n"),
            std::string::npos);
  EXPECT_NE(printed.find("disk = { radius = 1.0 }"), std::string::npos);
  EXPECT_EQ(printed.find("tension_only"), std::string::npos) << "does not apply to a disk";
  EXPECT_EQ(printed.find("stiffness"), std::string::npos) << "is not set";
  EXPECT_EQ(printed.find("ring"), std::string::npos);
}

TEST(Schema, ReportsTheMostImportantError) {
  const std::string wrong_app = "app = \"cloht\"\nmush = 1\n";
  EXPECT_EQ(error_of(wrong_app).substr(0, 22), "c.toml:1: app must be ");
  const std::string all = "app = \"cloth\"\n[material]\ncount = 99\n[[pin]]\nwere = \"x\"\n";
  EXPECT_EQ(error_of(all), "c.toml:5: unknown key \"pin[0].were\"; did you mean \"where\"?");
  const std::string value = "app = \"cloth\"\n[material]\ncount = 99\n";
  EXPECT_EQ(error_of(value), "c.toml:3: material.count = 99 is out of range: it must be 1 .. 10");
  EXPECT_EQ(error_of("app = \"cloth\"\n"), "c.toml:1: missing table \"mesh\": Mesh");
  EXPECT_EQ(error_of(""), "c.toml:1: missing key \"app\": Program");
}

TEST(Schema, FormerKeysNameTheirReplacement) {
  EXPECT_EQ(error_of(head + "[material]\nhardness = 2\n"),
            "c.toml:5: \"material.hardness\" is now stiffness, in N/m");
}

TEST(Schema, ErrorsNameKeyValueAndRange) {
  EXPECT_EQ(error_of(head + "[material]\ncount = 2.0\n"),
            "c.toml:5: material.count must be an integer 1 .. 10, not 2.0");
  EXPECT_EQ(error_of(head + "[material]\nstiffness = \"a\"\n"),
            "c.toml:5: material.stiffness must be a number >= 0, not the string \"a\"");
  EXPECT_EQ(error_of(head + "[material]\nstiffness = inf\n"),
            "c.toml:5: material.stiffness must be a finite number >= 0, not inf");
  EXPECT_EQ(error_of(head + "[material]\nshape = \"disc\"\n"),
            "c.toml:5: material.shape must be one of \"disk\", \"string\", not the string \"disc\"; did you "
            "mean \"disk\"?");
  EXPECT_EQ(error_of(head + "[material]\nstiffness = 1979-05-27\n"),
            "c.toml:5: material.stiffness must be a number >= 0, not a date or time");
  EXPECT_EQ(error_of(head + "[material]\npressure = \"x +\"\n"),
            "c.toml:5: material.pressure = \"x +\", at character 4: expected a number, a name or \"(\", not "
            "the end of the expression");
  EXPECT_EQ(error_of(head + "[material]\ninterval = [1, 1]\n"),
            "c.toml:5: material.interval[1] = 1.0 is not greater than the element before it, 1.0");
  EXPECT_EQ(error_of(head + "[material]\ninterval = [1]\n"),
            "c.toml:5: material.interval must be two numbers, not 1 number");
  EXPECT_EQ(error_of(head + "[[pin]]\nwhere = \"x\"\naxes = [1, \"b\", 2]\n"),
            "c.toml:6: pin[0].axes[1] must be a number, not the string \"b\"");
  EXPECT_EQ(error_of(head + "[[pin]]\nmotion = 1\n"), "c.toml:4: missing key \"pin[0].where\": Place");
  EXPECT_EQ(error_of("app = \"cloth\"\nmesh = 3\n"), "c.toml:2: mesh must be a table, not 3");
  EXPECT_EQ(error_of("app = \"cloth\"\npin = []\n[mesh]\ndisk = { radius = 1 }\n"),
            "c.toml:2: pin must be an array of tables, not an empty array");
  EXPECT_EQ(error_of("app = \"cloth\"\nradius = 2\n"),
            "c.toml:2: unknown key \"radius\"; did you mean \"mesh.disk.radius\"?");
}

TEST(Schema, RequiresExactlyOneAlternative) {
  EXPECT_EQ(error_of(head + "ring = { radius = 2 }\n"),
            "c.toml:4: mesh.ring contradicts mesh.disk: a scene has only one of them");
  EXPECT_EQ(error_of("app = \"cloth\"\n[mesh]\n"), "c.toml:2: [mesh] needs exactly one of disk, ring");
}

TEST(Schema, RefusesInapplicableKeys) {
  EXPECT_EQ(error_of(head + "[material]\ntension_only = true\n"),
            "c.toml:5: material.tension_only applies only with shape = \"string\"");
}

TEST(Schema, AssignmentDropsKeysThatItMakesInapplicable) {
  const std::string text = head + "[material]\nshape = \"string\"\ntension_only = true\n";
  EXPECT_FALSE(read_cloth(text, {"material.shape=disk"}).tension_only);
  EXPECT_EQ(error_of(text, {"material.shape=disk", "material.tension_only=true"}),
            "--set material.tension_only=true: material.tension_only applies only with shape = \"string\"");
  const Fabric cloth = read_cloth(text, {"mesh.ring={radius=3}"});
  EXPECT_FALSE(cloth.disk.has_value());
  EXPECT_EQ(cloth.ring->radius, 3.0);
  EXPECT_EQ(error_of(text, {"mesh.ring={radius=3}", "mesh.disk={radius=3}"}),
            "--set mesh.ring={radius=3}: mesh.ring contradicts mesh.disk: a scene has only one of them");
}

TEST(Schema, DocumentsEveryKey) {
  Fabric cloth;
  Table root;
  declare(root, cloth);
  const std::string text = document(root);
  EXPECT_NE(text.find("| `radius` | real | m | required | > 0 | Radius. |"), std::string::npos);
  EXPECT_NE(text.find("| `count` | integer |  | `3` | 1 .. 10 | Count. |"), std::string::npos);
  EXPECT_NE(text.find("## `[[pin]]`"), std::string::npos);
  EXPECT_NE(text.find("Only with shape = \"string\"."), std::string::npos);
  const auto paths = all_paths(root);
  EXPECT_NE(std::find(paths.begin(), paths.end(), "pin[].motion"), paths.end());
}

TEST(Schema, ConditionsNameTheirKeys) {
  const Choices<int> kinds = {{"a", 0}, {"b", 1}, {"c", 2}};
  int kind = 1;
  bool contact = true;
  std::optional<double> width;
  std::string file = "cloth.obj";
  const Condition of_kind = ChoiceKey("kind", kind, kinds).is({2, 1});
  EXPECT_EQ(of_kind.text, "with kind = \"b\" or \"c\"");
  EXPECT_EQ(of_kind.decided_by, "kind");
  EXPECT_TRUE(of_kind.applies());
  EXPECT_FALSE(with_given("width", width).applies());
  EXPECT_TRUE(with_given("file", file).applies());
  const Condition both = with_true("contact", contact) && of_kind;
  EXPECT_EQ(both.text, "with contact = true and kind = \"b\" or \"c\"");
  EXPECT_EQ(both.decided_by, "kind");
  EXPECT_TRUE(both.applies());
  kind = 0;
  EXPECT_FALSE(both.applies());
  kind = 1, contact = false;
  EXPECT_FALSE(both.applies());
  EXPECT_TRUE((Condition{} && Condition{}).applies()) << "one without a condition applies everywhere";
}

TEST(Place, RefusesAKeyByItsOriginItsPathAndASentence) {
  Fabric cloth;
  Table root;
  declare(root, cloth);
  read(root, parse_text(head + "[[pin]]\nwhere = \"x\"\nmotion = 1\n", "c.toml"));
  const Place pin = Place(root).at("pin", 0);
  EXPECT_EQ(pin.path("motion"), "pin[0].motion");
  EXPECT_TRUE(pin.given("motion"));
  EXPECT_FALSE(pin.given("axes"));
  EXPECT_EQ(testing::refusal_of([&] { pin.refuse("motion", " = ", 1.5, " m in ", 2, " steps"); }),
            "c.toml:6: pin[0].motion = 1.5 m in 2 steps");
  EXPECT_EQ(testing::refusal_of([&] { pin.refuse_if(true, "", " is loose"); }), "c.toml:4: pin[0] is loose");
  EXPECT_EQ(testing::refusal_of([&] { pin.contradict("axes", "no axes"); }), "c.toml:4: no axes");
  EXPECT_EQ(testing::refusal_of([&] { pin.refuse_if(false, "", " is loose"); }), "");
}

TEST(Nearest, CountsEdits) {
  EXPECT_EQ(edit_distance("weno", "weno"), 0);
  EXPECT_EQ(edit_distance("wneo", "weno"), 1);
  EXPECT_EQ(edit_distance("cell", "cells"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(suggestion("gama", {"cells", "gamma"}), "did you mean \"gamma\"?");
  EXPECT_EQ(suggestion("zzzzzz", {"cells", "gamma"}), "valid names are cells, gamma");
  EXPECT_EQ(suggestion("kuo", {"merton", "kou"}), "did you mean \"kou\"?");
  EXPECT_EQ(suggestion("heston", {"merton", "kou"}), "valid names are merton, kou");
  EXPECT_EQ(suggestion("prob", {"fields", "probes"}), "did you mean \"probes\"?");
  EXPECT_EQ(suggestion("dvidnd", {"dividend", "rate"}), "did you mean \"dividend\"?");
}

}  // namespace
}  // namespace drogue::scene
