#include "common/program/command_line.hpp"

#include <gtest/gtest.h>

#include "common/program/mini_app_options.hpp"
#include "tests/support/refusal.hpp"

namespace drogue {
namespace {

MiniAppOptions parse(std::vector<const char*> words) {
  words.insert(words.begin(), "drogue-gas");
  return parse_mini_app_options("drogue-gas", "Shock tubes.", static_cast<int>(words.size()), words.data(),
                                true);
}

/// Message of the usage failure for these arguments.
std::string usage_failure(const std::vector<const char*>& words) {
  return testing::refusal_of([&] { return parse(words); }, ExitCode::usage);
}

TEST(MiniAppOptions, HasTheDocumentedDefaults) {
  const MiniAppOptions options = parse({"sod"});
  EXPECT_EQ(options.scene, "sod");
  EXPECT_EQ(options.backend, "auto");
  EXPECT_TRUE(options.set.empty() && options.out.empty() && options.restart.empty() && options.study.empty());
  EXPECT_FALSE(options.check || options.print_scene || options.list_scenes || options.overwrite);
  EXPECT_FALSE(options.quiet || options.baseline || options.version);
  EXPECT_TRUE(options.help.empty() && options.kokkos.empty());
}

TEST(MiniAppOptions, ReadsEveryOption) {
  const MiniAppOptions options =
      parse({"--backend", "openmp", "--set", "mesh.cells=100", "sod.toml", "--set", "output.times=[0.1, 0.2]",
             "--out=here", "--overwrite", "--quiet", "--seed-mode"});
  EXPECT_EQ(options.scene, "sod.toml");
  EXPECT_EQ(options.backend, "openmp");
  EXPECT_EQ(options.set, (std::vector<std::string>{"mesh.cells=100", "output.times=[0.1, 0.2]"}));
  EXPECT_EQ(options.out, "here");
  EXPECT_EQ(parse({"sod", "--study", "meshes=100:800"}).study, "meshes=100:800");
  EXPECT_TRUE(options.overwrite && options.quiet && options.baseline);
  EXPECT_EQ(parse({"sod", "--restart", "auto"}).restart, "auto");
  EXPECT_TRUE(parse({"sod", "--check"}).check);
  EXPECT_TRUE(parse({"sod", "--print-scene"}).print_scene);
}

TEST(MiniAppOptions, AcceptsEqualSignsBlanksAndQuotesInValues) {
  const std::vector<std::string> expected = {R"(initial.expression.rho="1 + 0.2*sin(pi*x) = y")",
                                             "a.b=[[1,2],[3]]"};
  EXPECT_EQ(parse({"sod", "--set", expected[0].c_str(), "--set", expected[1].c_str()}).set, expected);
}

TEST(MiniAppOptions, ListScenesAndVersionRequireNoScene) {
  EXPECT_TRUE(parse({"--list-scenes"}).list_scenes);
  EXPECT_TRUE(parse({"--version"}).version);
  const std::string help = parse({"--help"}).help;
  for (const char* word :
       {"SCENE", "--backend", "--set", "--out", "--restart", "--check", "--print-scene", "--list-scenes",
        "--overwrite", "--quiet", "--seed-mode", "--study", "--version", "Shock tubes."}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}

TEST(MiniAppOptions, OffersTheBaselineOnlyWhereThereIsOne) {
  const auto without = [](std::vector<const char*> words) {
    words.insert(words.begin(), "drogue-parachute");
    return parse_mini_app_options("drogue-parachute", "Flow.", static_cast<int>(words.size()), words.data(),
                                  false);
  };
  EXPECT_EQ(without({"--help"}).help.find("--seed-mode"), std::string::npos);
  EXPECT_EQ(without({"cavity", "--study", "meshes=4:8"}).study, "meshes=4:8");
  EXPECT_THROW(without({"cavity", "--seed-mode"}), Failure);
}

TEST(MiniAppOptions, PassesKokkosOptionsThrough) {
  const MiniAppOptions options = parse({"--kokkos-num-threads=2", "sod", "--kokkos-tools-libs=a.so"});
  EXPECT_EQ(options.scene, "sod");
  EXPECT_EQ(options.kokkos, (std::vector<std::string>{"--kokkos-num-threads=2", "--kokkos-tools-libs=a.so"}));
}

TEST(MiniAppOptions, NamesTheOptionInError) {
  EXPECT_NE(usage_failure({}).find("no SCENE"), std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--bakend", "serial"}).find("'--bakend'; did you mean \"--backend\"?"),
            std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--overwrit=1"}).find("'--overwrit'; did you mean \"--overwrite\"?"),
            std::string::npos);
  EXPECT_NE(usage_failure({"sod", "lax"}).find("unexpected argument 'lax'"), std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--backend", "gpu"}).find("gpu"), std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--out"}).find("--out"), std::string::npos);
  EXPECT_EQ(usage_failure({"sod", "--backend", "serial", "--backend", "openmp"}),
            "--backend is given 2 times; give it once");
  EXPECT_EQ(usage_failure({"sod", "--out", "a", "--out", "b", "--out=c"}),
            "--out is given 3 times; give it once");
  EXPECT_NE(usage_failure({"sod", "--set", "mesh.cells"}).find("'mesh.cells'"), std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--overwrite", "--restart", "auto"}).find("--restart"), std::string::npos);
  EXPECT_NE(usage_failure({"sod", "--check", "--print-scene"}).find("--check"), std::string::npos);
}

TEST(MiniAppOptions, ReportsErrorsInOneSentence) {
  for (const auto& words : std::vector<std::vector<const char*>>{{},
                                                                 {"sod", "--bakend"},
                                                                 {"sod", "--backend", "gpu"},
                                                                 {"sod", "--out"},
                                                                 {"--set"},
                                                                 {"sod", "--set", "x"}}) {
    EXPECT_EQ(usage_failure(words).find('\n'), std::string::npos) << usage_failure(words);
  }
}

}  // namespace
}  // namespace drogue
