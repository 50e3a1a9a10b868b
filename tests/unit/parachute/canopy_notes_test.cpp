#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/scene/library.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::parachute_app {
namespace {

/// A C-9 in a box of 36 m with 14 cells across once it is open: nothing to note.
const char* const fit = R"(app = "parachute"
[fluid]
velocity = [0, 0, 10]
[grid]
cells = [90, 90, 90]
domain = [[-18, 18], [-18, 18], [-18, 18]]
boundary = { x = "slip", y = "slip", z = ["inflow", "outflow"] }
[[canopy]]
kind = "flat-circular"
edge_length = 0.2
payload = { fixed = true }
[coupling]
edge_inset = 0.55
[run]
end_time = 1
)";

std::vector<std::string> notes(const std::vector<std::string>& sets) {
  return read_flow_scene(testing::TemporaryFile(fit).path(), sets).notices;
}

/// Asserts that a scene has this note alone.
void expect_note(const std::vector<std::string>& sets, const std::string& note) {
  EXPECT_EQ(notes(sets), std::vector{note}) << sets.front();
}

TEST(CanopyNotes, ACanopyInFreeAirHasNone) { EXPECT_TRUE(notes({"run.end_time=1"}).empty()); }

TEST(CanopyNotes, NameWhatADuctTakesAndTheSectionThatIsFreeAir) {
  expect_note(
      {"grid.domain=[[-12,12],[-12,12],[-18,18]]", "canopy[0].edge_length=0.18"},
      "grid.domain: the open canopy covers 4.46 % of its section across z, so that drag and speed are "
      "those in a duct and not in free air; a square section of 36 m has at most 2 %");
}

TEST(CanopyNotes, NameTheWidthOfCellsThatACanopyNeeds) {
  expect_note({"grid.cells=[60,60,60]"},
              "grid: 9.53 cells across the 5.72 m of canopy[0] once it is open are too few for forces that "
              "hardly depend on them; cells of 0.476 m would be 12");
}

TEST(CanopyNotes, CellsThatRoundToTheLeastNumberSuffice) {
  const std::string side = "[-17.925,17.925]";
  EXPECT_TRUE(
      notes({"grid.cells=[75,75,75]", "grid.domain=[" + side + "," + side + "," + side + "]"}).empty())
      << "11.96 cells";
}

TEST(CanopyNotes, NameSidesThatHoldTheAir) {
  expect_note(
      {"grid.boundary.x=\"wall\""},
      "grid.boundary: walls at x_low and x_high hold the air back, so that drag and speed are not those "
      "in free air; \"slip\" sides, far away, do not");
  expect_note({"grid.boundary.z=\"periodic\""},
              "grid.boundary: no air passes z_low and z_high, so that a canopy drives the air of the domain "
              "along and its drag and speed are not those in free air; [\"inflow\", \"outflow\"] along the "
              "stream lets it pass");
}

TEST(CanopyNotes, NameAWakeThatTheDomainCutsOff) {
  const std::string note =
      "grid.domain ends 10 m behind the skirt of canopy[0], in a wake that still acts on it; at least 11.4 m "
      "are two open diameters";
  expect_note({"canopy[0].centre=[0,0,8]"}, note);
  expect_note({"canopy[0].centre=[0,0,-8]", "canopy[0].angle=180", "fluid.velocity=[0,0,-10]",
               "grid.boundary.z=[\"outflow\",\"inflow\"]"},
              note);
}

TEST(CanopyNotes, NameDefaultsOfAC9OfAnotherDiameter) {
  const std::vector<std::string> small = {"canopy[0].diameter=3", "grid.domain=[[-7,8],[-8,7],[-8,7]]",
                                          "canopy[0].edge_length=0.1"};
  expect_note(
      small,
      "canopy[0] is 3 m wide, but has by default vent = 0.457 m, gores = 28, lines.length = 7 m of a C-9 "
      "of 8.534 m; in proportion it has vent = 0.161, gores = 10, lines.length = 2.46");
  std::vector<std::string> own = small;
  own.insert(own.end(), {"canopy[0].vent=0.1", "canopy[0].gores=12"});
  expect_note(
      own,
      "canopy[0] is 3 m wide, but has by default lines.length = 7 m of a C-9 of 8.534 m; in proportion "
      "it has lines.length = 2.46");
  own.emplace_back("canopy[0].lines.length=2.5");
  EXPECT_TRUE(notes(own).empty());
}

TEST(CanopyNotes, NameEdgesThatActBeyondTheCloth) {
  expect_note(
      {"coupling.edge_inset=0"},
      "coupling.edge_inset = 0: skirt and vent act on the air 0.59 cells beyond the cloth, so that drag "
      "is some 17 % too large; coupling.edge_inset = 0.59 makes up for it");
  // Explicit coupling has none by default.
  expect_note(
      {"coupling={method=\"explicit\",allow_unstable=true}"},
      "coupling.edge_inset = 0: skirt and vent act on the air 0.59 cells beyond the cloth, so that drag "
      "is some 17 % too large; coupling.edge_inset = 0.59 makes up for it");
}

TEST(CanopyNotes, NameTheRoomThatACanopyNeedsInACore) {
  const std::vector<std::string> narrow = {"grid.core=[[-5.2,5.2],[-5.2,5.2],[-8,8]]", "grid.spacing=0.4"};
  expect_note(
      narrow,
      "grid.core leaves canopy[0] 4.4 m along x, and one that leans by 30 degrees needs 5.67 m to each "
      "side: it may leave the core, which ends the run");
  std::vector<std::string> wide = narrow;
  wide[0] = "grid.core=[[-7.2,7.2],[-7.2,7.2],[-8,8]]";
  EXPECT_TRUE(notes(wide).empty());
}

TEST(CanopyNotes, MeasureTheRoomOfACanopyThatStartsAskewFromItsPayload) {
  // The payload is 5.549 m from the skirt, of it 5.447 m across.
  std::vector<std::string> askew = {"grid.core=[[-7.2,7.2],[-7.2,7.2],[-8,8]]", "grid.spacing=0.4",
                                    "canopy[0].angle=79", "canopy[0].centre=[5.447,0,0]"};
  EXPECT_TRUE(notes(askew).empty());
  askew.back() = "canopy[0].centre=[0,0,0]";
  expect_note(
      askew,
      "grid.core leaves canopy[0] 0.953 m along x, and one that leans by 30 degrees needs 5.67 m to each "
      "side: it may leave the core, which ends the run");
}

TEST(CanopyNotes, NameSidesAlongWhichTheGridDoesNotFollowAGlide) {
  std::vector<std::string> free = {"grid.frame=\"follow\"", "canopy[0].payload={mass=90}",
                                   "grid.boundary.x=\"outflow\""};
  expect_note(free,
              "grid.boundary: the grid does not follow canopy[0] along y, and a free canopy glides: it may "
              "leave the grid, which ends the run; with y = \"outflow\" the grid follows");
  free.emplace_back("grid.boundary.y=\"outflow\"");
  EXPECT_TRUE(notes(free).empty());
  EXPECT_TRUE(notes({free[0], "canopy[0].payload={mass=90,guided=true}"}).empty());
}

TEST(CanopyNotes, ShippedScenesHaveNoneButThoseInADuct) {
  const std::filesystem::path source = DROGUE_SOURCE_DIR;
  std::set<std::string> noted;
  for (const auto& entry : scene::list_scenes(source / "miniapps/parachute/scenes"))
    // Full scenes take long to check.
    if (!entry.name.ends_with("-full") && !read_flow_scene(entry.file).notices.empty())
      noted.insert(entry.name);
  EXPECT_EQ(noted, (std::set<std::string>{"c9-duct", "cluster-3", "cup", "cup-reversed", "cylinder",
                                          "disk-normal", "sphere", "sphere-300"}));
}

TEST(CanopyNotes, CanopiesThatDoNotTrailTheirPayload) {
  EXPECT_TRUE(notes({"canopy[0].angle=75", "canopy[0].centre=[3,0,4]"}).empty());
  const auto across = notes({"fluid.velocity=[10,0,0]", "grid.boundary.x=[\"inflow\",\"outflow\"]"});
  ASSERT_EQ(across.size(), 1U);
  EXPECT_TRUE(across[0].starts_with("canopy[0].angle: the air meets the canopy at the start at 90 degrees"))
      << across[0];
  EXPECT_TRUE(std::ranges::any_of(notes({"fluid.velocity=[0,0,-10]"}), [](const std::string& note) {
    return note.starts_with("canopy[0].angle: the air meets the canopy at the start at 180 degrees");
  }));
}

TEST(CanopyNotes, AStreamIntoClosedSides) {
  EXPECT_TRUE(std::ranges::any_of(notes({"fluid.velocity=[1,0,10]"}), [](const std::string& note) {
    return note.starts_with("grid.boundary: no air passes x_low and x_high");
  }));
}

TEST(CanopyNotes, LinesLongerThanPublishedDragIsFor) {
  expect_note(
      {"canopy[0].lines={length=8.6}"},
      "canopy[0].lines.length: 1.01 diameters: such flat canopies sway here and have a drag coefficient "
      "of 0.9 and more, where 0.75 to 0.80 are published and lines of 0.7 to 0.8 diameters have 0.8");
  EXPECT_TRUE(notes({"canopy[0].lines={length=8.1}"}).empty());
}

TEST(CanopyNotes, PerturbationsThatStrainTheCloth) {
  expect_note(
      {"canopy[0].perturbation={amplitude=0.02,seed=1}"},
      "canopy[0].perturbation.amplitude = 0.02 m is 10 % of edge_length: cloth strained so far springs "
      "apart as it starts, which changes the opening, and may pull harder than that does; at most 5 %, "
      "here 0.01 m, do not");
  EXPECT_TRUE(notes({"canopy[0].perturbation={amplitude=0.01,seed=1}"}).empty());
  EXPECT_TRUE(
      notes({"canopy[0].edge_length=0.1999", "canopy[0].perturbation={amplitude=0.01,seed=1}"}).empty())
      << "the limit rounded to three digits";
}

TEST(CanopyNotes, SpeedsNearThatOfSoundInAirAndWaterAlone) {
  const std::string end =
      ", beyond the 0.3 up to which an incompressible flow stands for it: drag and forces lack its "
      "compressibility, and shocks";
  expect_note({"fluid.velocity=[0,0,120]"}, "fluid.velocity: 120 m/s are Mach 0.353 in air" + end);
  expect_note({"fluid.velocity=[0,0,\"10+110*t\"]"}, "fluid.velocity: 120 m/s are Mach 0.353 in air" + end);
  expect_note({"canopy[0].payload={velocity=[0,0,-100]}"},
              "canopy[0].payload.velocity: 110 m/s are Mach 0.324 in air" + end);
  expect_note({"fluid.velocity=[0,0,500]", "fluid.density=1000", "fluid.viscosity=1e-3"},
              "fluid.velocity: 500 m/s are Mach 0.338 in water" + end);
  EXPECT_TRUE(notes({"fluid.velocity=[0,0,101]"}).empty());
  EXPECT_TRUE(notes({"fluid.velocity=[0,0,120]", "fluid.viscosity=1"}).empty()) << "no air";
}

TEST(CanopyNotes, SheetsWithoutLinesHaveNone) {
  EXPECT_TRUE(notes({"canopy=[{kind=\"sheet\",diameter=3,vent=0,edge_length=0.2}]", "coupling.edge_inset=0"})
                  .empty());
}

}  // namespace
}  // namespace drogue::parachute_app
