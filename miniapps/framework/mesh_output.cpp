#include "miniapps/framework/mesh_output.hpp"

#include "kernels/mesh/edges.hpp"

namespace drogue::framework {

void write_mesh(run::FieldSink& fields, const mesh::Mesh& mesh, const std::string& strings,
                const std::string& grid) {
  const auto add = [&]<std::size_t n>(const char* name, const char* centering, const std::string& description,
                                      const std::vector<std::array<int, n>>& elements) {
    fields.add_mesh({.name = name,
                     .shape = {elements.size(), n},
                     .units = "1",
                     .centering = centering,
                     .description = description,
                     .grid = grid},
                    [&elements](std::uint64_t first, std::span<std::int64_t> values) {
                      for (std::size_t k = 0; k < values.size(); ++k)
                        values[k] = elements[(first + k) / n][(first + k) % n];
                    });
  };
  add("triangles", "face", "vertices of every triangle", mesh.triangles);
  add("edges", "edge", "vertices of every edge and line", mesh::edges_of(mesh));
  add("strings", "edge", strings, mesh.lines);
  fields.add_mesh({.name = "vertices",
                   .shape = {mesh.rest.size(), 3},
                   .units = "m",
                   .centering = "vertex",
                   .description = "vertices at rest",
                   .grid = grid},
                  [&mesh](std::uint64_t first, std::span<double> values) {
                    for (std::size_t k = 0; k < values.size(); ++k)
                      values[k] = mesh.rest[(first + k) / 3][(first + k) % 3];
                  });
}

}  // namespace drogue::framework
