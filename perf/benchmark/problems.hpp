#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Problems of `drogue-perf benchmark` (docs/benchmark.md): runs of the programs with shipped scenes, whose
/// answers are known.
namespace drogue::perf::benchmark {

/// One core, a node, and one GPU.
enum class Size { small, medium, large };

/// Names of the sizes, in their order.
inline const std::vector<std::string> size_names = {"small", "medium", "large"};

/// Run of a program with a known answer.
struct Problem {
  std::string name, program;
  std::string extent;  ///< cells, vertices or options, in words
  std::int64_t items = 0;
  std::vector<std::string> arguments;  ///< of the program: scene and changed keys, or batch and tolerance
  std::string quantity;                ///< check of the scene, or "price", whose error is the answer
  double low = 0.0, high = 0.0;        ///< bounds of that error for a right answer
  std::string merit;                   ///< key of `figure_of_merit` in result.json
  std::size_t puts = 0;                ///< of the batch to be written; 0 for scenes
  bool parallel = false;               ///< runs on several ranks
};

/// Problems of a size, in the order of the table. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Problem> problems(Size size);

/// The flow of a size with the cells of one rank on each of some ranks. Throws only std::bad_alloc.
[[nodiscard]] Problem flow_problem(Size size, int ranks);

}  // namespace drogue::perf::benchmark
