#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "common/csv/numbers.hpp"
#include "common/grid/stretched_axis.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Place, scene::rough_text;

constexpr std::size_t most_faces_per_axis = most_cells_per_axis + 1;

/// Sets an axis by its faces; cells of one width need none.
void set_faces(flow::Parameters& p, std::size_t axis, std::vector<double> faces) {
  p.cells[axis] = static_cast<int>(faces.size()) - 1;
  p.low[axis] = faces.front();
  p.high[axis] = faces.back();
  const double length = p.high[axis] - p.low[axis];
  bool is_uniform = true;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double equidistant = p.low[axis] + static_cast<double>(i) * (length / p.cells[axis]);
    is_uniform = is_uniform && std::abs(faces[i] - equidistant) <= 1e-12 * length;
  }
  p.faces[axis] = is_uniform ? std::vector<double>() : std::move(faces);
}

/// Notes cells that grow faster than those beside a core may, also from the last to the first of a periodic
/// axis.
void note_jumps(FlowScene& scene, const std::string& key, std::size_t axis) {
  constexpr double most = 1.1;
  const flow::Parameters& p = scene.parameters;
  const std::optional<SidePair>& sides = scene.sides[axis];
  const int n = p.cells[axis];
  const bool is_periodic = !sides || sides->front() == flow::BoundaryKind::periodic;
  double largest = 1.0;
  int at = 0;
  for (int i = is_periodic ? 0 : 1; i < n; ++i) {
    const double ratio = flow::cell_width(p, axis, i) / flow::cell_width(p, axis, (i + n - 1) % n),
                 growth = std::max(ratio, 1.0 / ratio);
    if (growth > largest) largest = growth, at = i;
  }
  if (largest <= most * (1.0 + 1e-6)) return;
  const std::string place =
      at == 0 ? std::string("the periodic sides") : rough_text(flow::face_coordinate(p, axis, at)) + " m";
  scene.note(key, ": the cells beside ", place, " differ in width by a factor of ", rough_text(largest),
             ", which costs accuracy there; at most ", most, " keeps it");
}

void complete_core(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = (*scene.core)[axis];
    root.refuse_if(low < p.low[axis] || high > p.high[axis], "grid.core", ": along ", axis_names[axis],
                   ", it reaches from ", low, " to ", high, " m, beyond grid.domain, ", p.low[axis], " to ",
                   p.high[axis], " m");
    root.refuse_if((high - low) / scene.spacing[axis] > most_cells_per_axis, "grid.spacing", ": ",
                   rough_text(scene.spacing[axis]), " m are more than ", most_cells_per_axis, " cells along ",
                   axis_names[axis]);
    std::vector<double> faces;
    try {
      faces = grid::stretched_faces({.low = p.low[axis],
                                     .high = p.high[axis],
                                     .core_low = low,
                                     .core_high = high,
                                     .spacing = scene.spacing[axis],
                                     .growth = scene.growth});
    } catch (const std::invalid_argument& fault) {
      root.refuse("grid.growth", ": along ", axis_names[axis], ", ", fault.what());
    }
    root.refuse_if(faces.size() > most_faces_per_axis, "grid.growth", ": along ", axis_names[axis],
                   ", core and growth give more than ", most_cells_per_axis, " cells");
    set_faces(p, axis, std::move(faces));
    note_jumps(scene, scene::sentence("grid.core along ", axis_names[axis]), axis);
  }
}

/// Numbers of a file, one a line; blank lines do not count.
std::vector<double> read_faces(const Place& root, const std::filesystem::path& file) {
  std::error_code unreadable;
  root.refuse_if(!std::filesystem::exists(file, unreadable), "grid.faces", ": there is no file ",
                 file.string());
  root.refuse_if(!std::filesystem::is_regular_file(file, unreadable), "grid.faces", ": ", file.string(),
                 " is no file but a directory or device");
  std::ifstream stream(file);
  std::vector<double> faces;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    constexpr const char* blanks = " \t\r";
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string::npos) continue;
    const std::string text = line.substr(begin, line.find_last_not_of(blanks) + 1 - begin);
    root.refuse_if(csv::parse_number(text, faces.emplace_back()) != csv::NumberError::none, "grid.faces",
                   ": ", file.string(), ":", number, " is not one finite number");
  }
  return faces;
}

void complete_faces(const Place& root, FlowScene& scene) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AxisFaces& given = (*scene.faces)[axis];
    if (!given.file.empty())
      given = {read_faces(root, std::filesystem::absolute(scene.file).parent_path() / given.file), ""};
    const std::vector<double>& faces = given.values;
    root.refuse_if(faces.size() < 2, "grid.faces", "[", axis, "]: an axis has two faces at least, not ",
                   faces.size());
    root.refuse_if(faces.size() > most_faces_per_axis, "grid.faces", "[", axis, "] has ", faces.size(),
                   " numbers, for more than ", most_cells_per_axis, " cells");
    const auto bad = std::ranges::adjacent_find(faces, [](double a, double b) { return !(a < b); });
    if (bad != faces.end())
      root.refuse("grid.faces", "[", axis, "]: ", bad[1], " follows ", bad[0],
                  "; the faces of an axis ascend");
    set_faces(scene.parameters, axis, faces);
    note_jumps(scene, scene::sentence("grid.faces[", axis, "]"), axis);
  }
}

}  // namespace

void complete_and_check_grid(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  for (std::size_t axis = 0; axis < 3; ++axis)
    p.low[axis] = scene.domain[axis][0], p.high[axis] = scene.domain[axis][1];
  if (scene.core) complete_core(root, scene);
  if (scene.faces) complete_faces(root, scene);
  const bool is_by_cells = !scene.core && !scene.faces;
  const std::string key = scene.core ? "grid.spacing" : scene.faces ? "grid.faces" : "grid.cells";
  constexpr int least_cells = 4;
  constexpr double most_cells = 2147483647.0;
  double cells = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p.cells[axis] > 1 && p.cells[axis] < least_cells) {
      const char* const rule = "an axis has 1 cell, or at least 4";
      if (is_by_cells) root.refuse(key, "[", axis, "] = ", p.cells[axis], " is out of range: ", rule);
      root.refuse(key, ": ", p.cells[axis], " cells along ", axis_names[axis], "; ", rule);
    }
    cells *= p.cells[axis];
    const double length = length_of(p, axis), h = core_width(p, axis);
    const double rounding =
        std::numeric_limits<double>::epsilon() * std::max(std::abs(p.low[axis]), std::abs(p.high[axis]));
    root.refuse_if(!std::isfinite(length) || h < 16.0 * rounding, scene.faces ? "grid.faces" : "grid.domain",
                   ": along ", axis_names[axis], ", ", p.cells[axis], " cells between ", p.low[axis], " and ",
                   p.high[axis], " have faces that do not differ in FP64");
  }
  root.refuse_if(cells > most_cells, key, ": ", static_cast<std::int64_t>(cells),
                 " cells are more than 2^31 - 1");
}

}  // namespace drogue::parachute_app
