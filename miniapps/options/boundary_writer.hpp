#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/run/atomic_file.hpp"
#include "kernels/options/pricer.hpp"

namespace drogue::options_app {

/// Writes exercise boundaries, a row a point: `id, time, spot`.
class BoundaryWriter {
 public:
  explicit BoundaryWriter(const std::filesystem::path& file);

  void write(const std::string& id, std::span<const options::BoundaryPoint> points);
  void commit();

 private:
  run::AtomicFile _file;
  std::string _text;
};

}  // namespace drogue::options_app
