#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/flow/axis_lines.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

// Grids with a core, and grids that are given by their faces.

namespace drogue::parachute_app {
namespace {

const char* const with_core = R"(app = "parachute"
[fluid]
velocity = [1, 0, 0]
[grid]
core = [[-1, 3], [-1, 1], [-1, 1]]
spacing = 0.25
domain = [[-5, 9], [-6, 6], [-1, 1]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[run]
end_time = 1
)";

const std::string cells = "grid.cells=[8,8,8]";

class GridScene : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { _file.add(name, text); }
  FlowScene read(const std::vector<std::string>& sets = {}, const std::string& text = with_core) const {
    write("scene.toml", text);
    return read_flow_scene(_file.path(), sets);
  }
  /// Sentence with which a scene is refused, without the name of the file.
  std::string refusal(const std::vector<std::string>& sets, const std::string& text = with_core) const {
    const std::string sentence = testing::refusal_of([&] { return read(sets, text); }),
                      file = _file.path().string();
    return sentence.starts_with(file) ? sentence.substr(file.size() + 1) : sentence;
  }

  const testing::TemporaryFile _file{with_core};
};

/// The scene with other text for its grid.
std::string with_grid(const std::string& lines) {
  std::string text = with_core;
  const std::size_t begin = text.find("core ="), end = text.find("boundary");
  return text.replace(begin, end - begin, lines);
}

TEST_F(GridScene, ACoreGivesFacesThatGrowOutsideOfIt) {
  const FlowScene scene = read();
  const flow::Parameters& p = scene.parameters;
  EXPECT_EQ(scene.growth, 1.06);
  EXPECT_TRUE(p.faces[2].empty());
  EXPECT_EQ(p.cells[2], 8);
  const flow::Core core = flow::core_of(p);
  EXPECT_EQ(core.cells, (std::array<int, 3>{16, 8, 8}));
  EXPECT_NEAR(core.low[0], -1.0, 1e-14);
  EXPECT_NEAR(core.high[0], 3.0, 1e-14);
  EXPECT_EQ(p.low, (std::array<double, 3>{-5.0, -6.0, -1.0}));
  EXPECT_EQ(p.high, (std::array<double, 3>{9.0, 6.0, 1.0}));
  for (const std::size_t axis : {0U, 1U})
    for (int i = 1; i < p.cells[axis]; ++i) {
      const double ratio = flow::cell_width(p, axis, i) / flow::cell_width(p, axis, i - 1);
      EXPECT_LE(std::max(ratio, 1.0 / ratio), 1.06 + 1e-9);
    }
  EXPECT_LT(p.cells[1], 8 + 2 * 17);
  EXPECT_GT(read({"grid.growth=1.02"}).parameters.cells[1], p.cells[1]);
}

TEST_F(GridScene, ItsTextResolvesToItself) {
  const std::string printed = print_flow_scene(read());
  EXPECT_EQ(print_flow_scene(read({}, printed)), printed);
  EXPECT_NE(printed.find("core = [[-1.0, 3.0]"), std::string::npos);
  EXPECT_EQ(printed.find("cells ="), std::string::npos);
  const std::string by_faces = with_grid("faces = [[0, 1, 2, 3, 4], [0, 1, 2.5, 3, 4], [0, 1]]\n");
  const std::string text = print_flow_scene(read({}, by_faces));
  EXPECT_EQ(print_flow_scene(read({}, text)), text);
  EXPECT_EQ(text.find("domain ="), std::string::npos);
}

TEST_F(GridScene, FacesOfOneWidthAreAUniformGrid) {
  const FlowScene scene = read({}, with_grid("faces = [[0, 0.5, 1, 1.5, 2], [0, 1, 2.5, 3, 4], [-1, 1]]\n"));
  const flow::Parameters& p = scene.parameters;
  EXPECT_EQ(p.cells, (std::array<int, 3>{4, 4, 1}));
  EXPECT_TRUE(p.faces[0].empty());
  EXPECT_EQ(p.faces[1], (std::vector<double>{0.0, 1.0, 2.5, 3.0, 4.0}));
  EXPECT_EQ(p.high, (std::array<double, 3>{2.0, 4.0, 1.0}));
  EXPECT_FALSE(read({cells}).has_stretched_axes());
  EXPECT_EQ(read({"grid.faces=[[0,0.5,1,1.5,2],[0,1,2.5,3,4],[-1,1]]"}).parameters.faces, p.faces);
  // Cells that differ by much are noted.
  ASSERT_EQ(scene.notices.size(), 1U);
  EXPECT_EQ(
      scene.notices[0],
      "grid.faces[1]: the cells beside 2.5 m differ in width by a factor of 3, which costs accuracy there; "
      "at most 1.1 keeps it");
  const FlowScene beside_a_side = read({"grid.core=[[-5,-1],[-6,6],[-1,1]]", "grid.boundary.x=\"periodic\""});
  ASSERT_EQ(beside_a_side.notices.size(), 1U);
  EXPECT_NE(
      beside_a_side.notices[0].find("grid.core along x: the cells beside the periodic sides differ in width"),
      std::string::npos)
      << beside_a_side.notices[0];
  // A core that is the whole domain is one, too.
  const FlowScene whole = read({"grid.core=[[-5,9],[-6,6],[-1,1]]"});
  EXPECT_FALSE(whole.has_stretched_axes());
  EXPECT_EQ(whole.parameters.cells, (std::array<int, 3>{56, 48, 8}));
}

TEST_F(GridScene, FacesComeFromFilesToo) {
  write("y.txt", "0\n1\n 2.5 \n3\n4\n\n");
  const FlowScene by_file = read({}, with_grid("faces = [[0, 1, 2, 3, 4], \"y.txt\", [0, 1]]\n")),
                  by_list = read({}, with_grid("faces = [[0, 1, 2, 3, 4], [0, 1, 2.5, 3, 4], [0, 1]]\n"));
  EXPECT_EQ(by_file.parameters.faces, by_list.parameters.faces);
  EXPECT_EQ(print_flow_scene(by_file), print_flow_scene(by_list));
  write("y.txt", "0\n1\ntwo\n");
  const std::string grid = with_grid("faces = [[0, 1, 2, 3, 4], \"y.txt\", [0, 1]]\n");
  EXPECT_TRUE(refusal({}, grid).ends_with("y.txt:3 is not one finite number")) << refusal({}, grid);
  EXPECT_NE(refusal({}, with_grid("faces = [[0, 1, 2, 3, 4], \"z.txt\", [0, 1]]\n")).find("there is no file"),
            std::string::npos);
}

TEST_F(GridScene, AnotherGridIsAnotherRun) {
  const auto fingerprint_of = [](const FlowScene& scene) {
    return framework::fingerprint(scene_identity(scene));
  };
  EXPECT_EQ(fingerprint_of(read()), fingerprint_of(read({"run.end_time=2"})));
  for (const char* set : {"grid.growth=1.05", "grid.spacing=0.24", "grid.core=[[-1,2],[-1,1],[-1,1]]"})
    EXPECT_NE(fingerprint_of(read()), fingerprint_of(read({set}))) << set;
}

TEST_F(GridScene, RefusesWhatContradictsOrIsNoGrid) {
  const std::pair<std::string, std::string> bad[] = {
      {"core = [[-1, 3], [-1, 1], [-1, 1]]\nspacing = 0.25\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\ncells = "
       "[8, 8, 8]\n",
       "8: grid.cells applies only without core and faces"},
      {"domain = [[-5, 9], [-6, 6], [-1, 1]]\n", "4: [grid] needs exactly one of cells, core, faces"},
      {"cells = [8, 8, 8]\nspacing = 0.25\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\n",
       "6: grid.spacing applies only with core"},
      {"core = [[-1, 3], [-1, 1], [-1, 1]]\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\n",
       "4: missing key \"grid.spacing\" (needed with core)"},
      {"core = [[-1, 3], [-1, 1], [-2, 1]]\nspacing = 0.25\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\n",
       "5: grid.core: along z, it reaches from -2.0 to 1.0 m, beyond grid.domain, -1.0 to 1.0 m"},
      {"core = [[-1, 3], [-1, 1], [-1, 1]]\nspacing = 1\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\n",
       "6: grid.spacing: 2 cells along z; an axis has 1 cell, or at least 4"},
      {"core = [[-1, 3], [-1, 1], [-1, 1]]\nspacing = 1e-5\ndomain = [[-5, 9], [-6, 6], [-1, 1]]\n",
       "6: grid.spacing: 1e-05 m are more than 16384 cells"},
      {"core = [[-1, 3], [-1, 1], [-1, 1]]\nspacing = 0.25\ngrowth = 1.2\ndomain = [[-5, 9], [-6, 6], [-1, "
       "1]]\n",
       "7: grid.growth = 1.2 is out of range"},
      {"faces = [[0, 1, 2, 3, 4], [0, 1, 1, 3, 4], [0, 1]]\n",
       "5: grid.faces[1]: 1.0 follows 1.0; the faces of an axis ascend"},
      {"faces = [[0, 1, 2, 3, 4], [0], [0, 1]]\n", "5: grid.faces[1]: an axis has two faces at least, not 1"},
      {"faces = [[0, 1, 2, 3, 4], [0, 1, 2, 3, 4], [0, 1]]\ndomain = [[0, 4], [0, 4], [0, 1]]\n",
       "6: grid.domain applies only without faces"}};
  for (const auto& [lines, sentence] : bad) {
    const std::string found = refusal({}, with_grid(lines));
    EXPECT_TRUE(found.starts_with(sentence)) << found << "\n  for\n" << lines;
  }
}

TEST_F(GridScene, BodiesLieInTheCore) {
  const std::string plate =
      "body=[{kind='plate',normal='x',centre=[0,0,0],lengths=[0.9,2],edge_length=0.15}]";
  EXPECT_EQ(refusal({plate}), "");
  EXPECT_NE(
      refusal({plate, "body[0].centre=[2.6,0,0]"})
          .find("body[0] reaches from 2.6 to 2.6 m along x, beyond the core of the grid less two cells at "
                "each end: it must lie strictly between -0.5 and 2.5 m"),
      std::string::npos)
      << refusal({plate, "body[0].centre=[2.6,0,0]"});
  EXPECT_NE(refusal({plate, "body[0].edge_length=0.07",
                     "grid.faces=[[-2,-1,-0.1,0.1,1,2],[-1,-0.9,0,0.9,1],[-1,-0.9,0,0.9,1]]"})
                .find("body[0] has no room in the core of the grid, which has 1 cells along x"),
            std::string::npos);
  // A side of the domain that the core reaches is a side as of other grids.
  EXPECT_EQ(refusal({plate, "grid.domain=[[-1,9],[-6,6],[-1,1]]", "body[0].centre=[-0.7,0,0]"}), "");
}

TEST_F(GridScene, CellsBesideTheCoreAreNotTooMany) {
  for (const char* low : {"-5e4", "-5e8"})
    EXPECT_NE(
        refusal({"grid.growth=1.0000000001", std::string("grid.domain=[[") + low + ",9],[-6,6],[-1,1]]"})
            .find("grid.growth: along x, "),
        std::string::npos)
        << low;
}

TEST_F(GridScene, CheckStatesItsSize) {
  const RunSize size = run_size(read({"run.dt=0.01"}));
  EXPECT_EQ(size.cells, read().cells());
  EXPECT_EQ(size.steps, 100.0);
  EXPECT_GT(size.bytes, 8.0 * 12.0 * size.cells);
  EXPECT_LT(size.bytes, 8.0 * 60.0 * size.cells);
  const std::string report = run_size_report(read());
  for (const char* words : {"cells, ", "along x a core of 16 of 0.25 m, others up to ",
                            "along y a core of 8 of 0.25 m", "MiB", "an estimate: "})
    EXPECT_NE(report.find(words), std::string::npos) << report;
}

}  // namespace
}  // namespace drogue::parachute_app
