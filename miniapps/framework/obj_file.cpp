#include "miniapps/framework/obj_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"
#include "kernels/mesh/polygon.hpp"
#include "kernels/mesh/topology.hpp"

namespace drogue::framework {
namespace {

/// Statements that cloth has no use for.
const std::vector<std::string> skipped = {"p", "vn", "vt", "vp", "o", "g", "s", "usemtl", "mtllib"};

constexpr std::size_t most_file_vertices = std::size_t{1} << 26U;

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name) : _text(text), _name(name) {}

  ObjContents run() {
    if (_text.starts_with("\xFF\xFE") || _text.starts_with("\xFE\xFF"))
      refuse_at(1, "the file is UTF-16; save it as UTF-8");
    if (_text.starts_with("\xEF\xBB\xBF")) _text.remove_prefix(3);
    while (!_text.empty()) {
      std::string line(next_line());
      int continued = 0;
      for (; is_continued(line); ++continued) {
        line.back() = ' ';
        line += next_line();
      }
      ++_line;  // errors name the first line of a statement
      statement(words_of(line));
      _line += continued;
    }
    _line = std::max(_line, 1);
    if (_contents.mesh.rest.empty()) refuse("the file has no vertex (v x y z)");
    add_triangles();
    check_range(_contents.mesh.lines, _contents.line_line);
    return std::move(_contents);
  }

 private:
  /// Polygon of the file.
  struct Face {
    std::vector<int> corners;
    int line;
  };

  /// Takes the next line from the text, without its end: LF, CR LF or CR.
  std::string_view next_line() {
    const std::size_t end = _text.find_first_of("\r\n");
    const std::string_view line = _text.substr(0, end);
    const bool has_both = end != std::string_view::npos && _text.substr(end).starts_with("\r\n");
    _text.remove_prefix(end == std::string_view::npos ? _text.size() : end + (has_both ? 2 : 1));
    return line;
  }

  /// True for a line that ends with a backslash, other than that of a comment.
  [[nodiscard]] bool is_continued(const std::string& line) const {
    return !_text.empty() && line.ends_with('\\') && line.find('#') == std::string::npos;
  }

  [[noreturn]] void refuse(const std::string& sentence) const { refuse_at(_line, sentence); }
  [[noreturn]] void refuse_at(int line, const std::string& sentence) const {
    throw Failure(ExitCode::invalid_scene, _name + ":" + std::to_string(line) + ": " + sentence);
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    line = line.substr(0, line.find('#'));
    std::vector<std::string_view> words;
    constexpr std::string_view blanks = " \t\r\f\v";
    for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
      const std::size_t end = line.find_first_of(blanks, begin);
      words.push_back(line.substr(begin, end - begin));
      begin = end == std::string_view::npos ? end : line.find_first_not_of(blanks, end);
    }
    return words;
  }

  void statement(const std::vector<std::string_view>& words) {
    if (words.empty()) return;
    const std::string kind(words[0]);
    if (kind == "v") return vertex(words);
    if (kind == "f") return face(words);
    if (kind == "l") return polyline(words);
    for (const std::string& known : skipped)
      if (kind == known) return;
    std::string passed_over;
    for (const std::string& known : skipped) passed_over += (passed_over.empty() ? "" : ", ") + known;
    refuse("unknown statement " + scene::toml_string(kind) + "; valid are v, f, l, and without effect " +
           passed_over);
  }

  void vertex(const std::vector<std::string_view>& words) {
    const std::string which = part_of_file("vertex", _contents.mesh.rest.size());
    const bool weighted = words.size() == 5, coloured = words.size() == 7;
    if (words.size() != 4 && !weighted && !coloured)
      refuse(which + " has " + std::to_string(words.size() - 1) +
             " numbers; it must have 3 coordinates, and after them nothing, a weight of 1 or a colour of 3");
    mesh::Vector point;
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = real(words[axis + 1], which);
    for (std::size_t k = 4; k < words.size(); ++k)
      if (real(words[k], which) != 1.0 && weighted)
        refuse(which + " has the weight " + std::string(words[k]) +
               "; only 1 is taken, which weights of curves and surfaces are not");
    if (_contents.mesh.rest.size() == most_file_vertices) refuse("the file has more than 67108864 vertices");
    _contents.mesh.rest.push_back(point);
    _contents.vertex_line.push_back(_line);
  }

  double real(std::string_view word, const std::string& which) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      refuse(which + ": " + scene::toml_string(word) + " is not a finite number");
    return value;
  }

  void face(const std::vector<std::string_view>& words) {
    const std::string which = part_of_file("face", _faces.size());
    if (words.size() < 4)
      refuse(which + " has " + std::to_string(words.size() - 1) + " vertices; it must have 3 or more");
    Face face{{}, _line};
    for (std::size_t k = 1; k < words.size(); ++k) face.corners.push_back(index(words[k], which));
    std::vector<int> sorted = face.corners;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      refuse(which + " names vertex " + std::to_string(*twice + 1) + " twice");
    _faces.push_back(std::move(face));
  }

  /// Divides the faces, whose vertices may follow them in the file.
  void add_triangles() {
    for (std::size_t k = 0; k < _faces.size(); ++k) {
      const Face& face = _faces[k];
      for (const int i : face.corners) require_vertex(i, part_of_file("face", k), face.line);
      const auto triangles = mesh::triangulate(_contents.mesh.rest, face.corners);
      if (triangles.empty())
        refuse_at(face.line,
                  part_of_file("face", k) + " has no area or crosses itself; divide it into triangles");
      for (const std::array<int, 3>& triangle : triangles) {
        _contents.mesh.triangles.push_back(triangle);
        _contents.triangle_line.push_back(face.line);
        _contents.face_of.push_back(k);
      }
    }
  }

  void polyline(const std::vector<std::string_view>& words) {
    if (words.size() < 3) refuse("a line needs two vertices or more");
    int before = index(words[1], "line");
    for (std::size_t k = 2; k < words.size(); ++k) {
      const int here = index(words[k], "line");
      if (here == before)
        refuse("a line leads from " + part_of_file("vertex", static_cast<std::size_t>(here)) + " to itself");
      _contents.mesh.lines.push_back({before, here});
      _contents.line_line.push_back(_line);
      before = here;
    }
  }

  /// `7`, `7/1`, `7/1/2`, `7//2`, or `-1` for the vertex given last. Vertices may be given later in the file.
  int index(std::string_view word, const std::string& which) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || digits.empty())
      refuse(which + ": " + scene::toml_string(word) + " is not the number of a vertex");
    const auto given = static_cast<std::int64_t>(_contents.mesh.rest.size());
    const std::int64_t place = number < 0 ? given + number : number - 1;
    if (number == 0 || place < 0 || place > std::numeric_limits<int>::max())
      refuse(which + " names vertex " + std::to_string(number) + ", which does not exist; they count from 1");
    return static_cast<int>(place);
  }

  void check_range(const std::vector<std::array<int, 2>>& parts, const std::vector<int>& lines) const {
    for (std::size_t k = 0; k < parts.size(); ++k)
      for (const int i : parts[k]) require_vertex(i, "line", lines[k]);
  }

  void require_vertex(int i, const std::string& part, int line) const {
    if (static_cast<std::size_t>(i) >= _contents.mesh.rest.size())
      refuse_at(line, part + " names vertex " + std::to_string(i + 1) + "; the file has " +
                          std::to_string(_contents.mesh.rest.size()));
  }

  std::string_view _text;
  const std::string& _name;
  int _line = 0;
  std::vector<Face> _faces;
  ObjContents _contents;
};

}  // namespace

std::string part_of_file(const std::string& kind, std::size_t k) {
  return kind + " " + std::to_string(k + 1) + " of the file";
}

namespace {

/// Files whose parts were written one after the other often have two vertices where one is meant.
void warn_of_near_vertices(const ObjContents& contents, const std::string& file,
                           std::vector<std::string>& notices) {
  constexpr double near = 1e-6;  // of the extent
  const auto pair = mesh::near_vertices(contents.mesh, near * mesh::extent_of(contents.mesh));
  if (!pair) return;
  const auto [first, second] = *pair;
  const auto later = static_cast<std::size_t>(second);
  notices.push_back(file + ":" + std::to_string(contents.vertex_line[later]) + ": " +
                    part_of_file("vertex", later) + " lies nearer to vertex " + std::to_string(first + 1) +
                    " than 1e-6 of the extent of the mesh; if both are the same, name one in both places");
}

}  // namespace

ObjContents parse_obj(std::string_view text, const std::string& name) { return ObjParser(text, name).run(); }

mesh::Mesh read_obj(const scene::Place& at, double metres, const std::filesystem::path& scene_file,
                    std::string& file, std::vector<std::string>& notices) {
  const std::filesystem::path path =
      std::filesystem::absolute(scene_file.parent_path() / file).lexically_normal();
  file = path.string();
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) {
    if (std::filesystem::exists(path, unreadable))
      at.refuse("file", ": ", file, " is no file but a directory or device");
    at.refuse("file", ": there is no file ", file);
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf()))
    throw Failure(ExitCode::invalid_scene, file + ":1: the mesh file is empty or cannot be read");
  ObjContents contents = parse_obj(text.str(), file);
  check_obj(contents, file);
  warn_of_near_vertices(contents, file, notices);
  for (mesh::Vector& x : contents.mesh.rest)
    for (double& coordinate : x) coordinate *= metres;
  const double extent = mesh::extent_of(contents.mesh);
  at.refuse_if(!(extent >= 1e-60 && extent <= 1e60), "scale", " = ", metres, ": ", file, " would be ", extent,
               " m large; it must be between 1e-60 and 1e60 m");
  return contents.mesh;
}

std::string contents_of(const mesh::Mesh& mesh) {
  std::string text;
  for (const mesh::Vector& x : mesh.rest) text.append(reinterpret_cast<const char*>(x.data()), sizeof x);
  for (const auto& triangle : mesh.triangles)
    for (const int i : triangle) text += std::to_string(i) + " ";
  for (const auto& line : mesh.lines)
    for (const int i : line) text += std::to_string(i) + " ";
  return text;
}

}  // namespace drogue::framework
