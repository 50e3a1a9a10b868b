#include "common/scene/parse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/refusal.hpp"

namespace drogue::scene {
namespace {

std::string syntax_error(const std::string& text) {
  return testing::refusal_of([&] { parse_text(text, "f.toml"); });
}

TEST(NodeText, RoundsComputedNumbersInSentences) {
  EXPECT_EQ(rounded_text(0.1 - 0.3), "-0.2");
  EXPECT_EQ(rounded_text(-0.19999999999999998), "-0.2");
  EXPECT_EQ(rounded_text(1.0), "1.0");
  EXPECT_EQ(rounded_text(0.123456789012), "0.123456789012");
  EXPECT_EQ(rounded_text(std::nextafter(3e200, 1e300)), "3e+200");
  EXPECT_EQ(rounded_text(std::nan("")), "nan");
}

TEST(Parse, KeepsOrderTypesAndLines) {
  const Node root = parse_text("z = 1\na = 2.5\n\n[t]\nb = [true, \"x\"]\n", "f.toml");
  const auto& members = *root.as<Node::Table>();
  ASSERT_EQ(members.size(), 3U);
  EXPECT_EQ(members[0].name, "z");
  EXPECT_EQ(*members[0].node.as<std::int64_t>(), 1);
  EXPECT_EQ(members[1].origin, "f.toml:2");
  EXPECT_EQ(*members[1].node.as<double>(), 2.5);
  EXPECT_EQ(members[2].node.find("b")->origin, "f.toml:5");
  const auto& array = *members[2].node.find("b")->as<Node::Array>();
  EXPECT_EQ(*array[0].as<bool>(), true);
  EXPECT_EQ(*array[1].as<std::string>(), "x");
}

TEST(Parse, ReportsTheLineOfASyntaxError) {
  EXPECT_EQ(syntax_error("a = 1\nb = \n").substr(0, 10), "f.toml:2: ");
  EXPECT_EQ(syntax_error("a = 1\n\n[t\n").substr(0, 10), "f.toml:3: ");
  EXPECT_EQ(syntax_error("a = 1\na = 2\n").substr(0, 10), "f.toml:2: ");
  EXPECT_EQ(syntax_error("[t]\nx = 1\n[t]\nx = 2\n").substr(0, 10), "f.toml:3: ");
  EXPECT_EQ(syntax_error("a = 1\nb = \"\xff\xfe\"\n").substr(0, 10), "f.toml:2: ");
  EXPECT_EQ(syntax_error("a = 99999999999999999999\n").substr(0, 10), "f.toml:1: ");
  EXPECT_EQ(syntax_error("a = { b = 1 }\n\n[a.c]\nx = 1\n").substr(0, 10), "f.toml:3: ");
  EXPECT_EQ(syntax_error("a = [\n1]\n[.b]\nx = 1\n").substr(0, 10), "f.toml:3: ")
      << "toml++ 3.3 asserts here";
}

TEST(Parse, ReportsUnreadableFilesAsUsageErrors) {
  EXPECT_NE(testing::refusal_of([] { parse_file("no-such.toml"); }, ExitCode::usage).find("no-such.toml"),
            std::string::npos);
  EXPECT_NE(testing::refusal_of([] { parse_file("."); }, ExitCode::usage).find("folder"), std::string::npos);
}

Node with_set(const std::string& assignment) {
  Node root =
      parse_text("[gas]\ngamma = 1.4\n[a]\nlist = [1, 2]\nrows = [[1], [2]]\n[[b]]\nc = 1\n", "f.toml");
  apply_set(root, assignment);
  return root;
}

TEST(Set, ReplacesAndAddsValues) {
  EXPECT_EQ(*with_set("gas.gamma=1.6").find("gas")->find("gamma")->as<double>(), 1.6);
  EXPECT_EQ(*with_set("gas.gamma = 2").find("gas")->find("gamma")->as<std::int64_t>(), 2);
  EXPECT_EQ(*with_set("scheme.weno=js").find("scheme")->find("weno")->as<std::string>(), "js");
  EXPECT_EQ(*with_set("scheme.weno=\"js\"").find("scheme")->find("weno")->as<std::string>(), "js");
  EXPECT_EQ(with_set("x.y.z=[1, 2]").find("x")->find("y")->find("z")->as<Node::Array>()->size(), 2U);
  EXPECT_EQ(*(*with_set("a.list.1=7").find("a")->find("list")->as<Node::Array>())[1].as<std::int64_t>(), 7);
  for (const char* each : {"b.0.c=9", "b[0].c=9"})
    EXPECT_EQ(*(*with_set(each).find("b")->as<Node::Array>())[0].find("c")->as<std::int64_t>(), 9) << each;
  const Node nested = with_set("a.rows[1][0]=7");
  EXPECT_EQ(
      *(*(*nested.find("a")->find("rows")->as<Node::Array>())[1].as<Node::Array>())[0].as<std::int64_t>(), 7);
}

TEST(Set, ReportsTheAssignmentInError) {
  for (const std::string bad : {"gas.gamma.x=1", "gas", "=1", "gas.=1", ".gas=1", "a..b=1",
                                "gas.gamma=", "gas.gamma=[1", "gas.gamma=\"", "a.list.2=1", "a.list.x=1",
                                "a.list.99999999999999999999=1", "gas.gamma=1\nx=2", "gas.gamma=1]"}) {
    const std::string message = testing::refusal_of([&] { with_set(bad); });
    EXPECT_EQ(message.substr(0, bad.size() + 8), "--set " + bad + ": ") << bad;
  }
  EXPECT_EQ(with_set("gas.gamma=2").as<Node::Table>()->front().node.as<Node::Table>()->front().origin,
            "--set gas.gamma=2");
}

TEST(Set, RejectsBracketsThatEncloseNoIndex) {
  for (const std::string bad :
       {"b[0.c=9", "b[0=9", "b[=9", "b0].c=9", "b[].c=9", "b[0]c=9", "b[0]].c=9", "b[[0]].c=9", "b[-1].c=9",
        "b[x].c=9", "b.[0].c=9", "[0].c=9", "gas[gamma=2", "gas]gamma=2", "gas[gamma]=2", "gas[a=[0, 1]"})
    EXPECT_EQ(testing::refusal_of([&] { with_set(bad); }),
              "--set " + bad + ": the key is not of the form table.key or array[0].key");
}

TEST(Node, PrintedTextReadsBack) {
  for (const double value : {1.0, 0.1, -2.5e-300, 1e22, 1.0 / 3.0, 5e-324, 1.7976931348623157e308}) {
    const Node root = parse_text("v = " + real_text(value) + "\n", "f");
    EXPECT_EQ(*root.find("v")->as<double>(), value);
  }
  for (const std::string text :
       {"plain", "quote \" and \\", "line\nbreak\tand \x01 \x7f", "\xc3\xa9t\xc3\xa9"}) {
    const Node root = parse_text("v = " + toml_string(text) + "\n", "f");
    EXPECT_EQ(*root.find("v")->as<std::string>(), text);
  }
}

}  // namespace
}  // namespace drogue::scene
