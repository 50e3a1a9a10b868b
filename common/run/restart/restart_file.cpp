#include "common/run/restart/restart_file.hpp"

#include <unistd.h>

#include <map>
#include <utility>

#include "common/program/failure.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/hdf5/hdf5.hpp"
#include "common/run/restart/checksum.hpp"
#include "common/run/restart/restart_seal.hpp"
#include "common/scene/node.hpp"

namespace drogue::run {

std::string fingerprint(std::string_view text) {
  Checksum checksum;
  checksum.add({text.data(), text.size()});
  return hexadecimal(checksum.value());
}

void require_not_after(const std::filesystem::path& file, double time, const char* key, double end) {
  if (time <= end) return;
  throw Failure(ExitCode::io_error, "cannot continue from restart file '" + file.string() +
                                        "': it is of t = " + scene::real_text(time) + " s, later than " +
                                        key + " = " + scene::real_text(end));
}

struct RestartWriter::State {
  std::filesystem::path target;
  std::filesystem::path temporary;
  std::string scene;
  h5::Handle file;
  std::map<std::string, h5::Handle> arrays;
};

RestartWriter::RestartWriter(std::filesystem::path file, const std::string& scene)
    : _state(std::make_unique<State>()) {
  _state->target = std::move(file);
  _state->temporary = temporary_name(_state->target);
  _state->scene = scene;
  _state->file = h5::create_file(_state->temporary, seal_bytes);
}

RestartWriter::~RestartWriter() {
  if (!_state) return;
  _state->arrays.clear();
  _state->file.reset();
  unlink(_state->temporary.c_str());
}

void RestartWriter::number(const std::string& name, double value) {
  h5::write_attribute(_state->file, name, value);
}

void RestartWriter::integer(const std::string& name, std::int64_t value) {
  h5::write_attribute(_state->file, name, value);
}

void RestartWriter::text(const std::string& name, const std::string& value) {
  h5::write_attribute(_state->file, name, value);
}

void RestartWriter::array(const std::string& name, std::uint64_t size) {
  _state->arrays[name] = h5::create_dataset(_state->file, name, H5T_NATIVE_DOUBLE, {size});
}

void RestartWriter::write(const std::string& name, std::uint64_t first, std::span<const double> values) {
  h5::write(_state->arrays.at(name), first, values);
}

void RestartWriter::commit() {
  _state->arrays.clear();
  _state->file.close_file();
  write_seal(_state->temporary, _state->scene);
  replace_file(_state->temporary, _state->target);
  _state.reset();
}

struct RestartReader::State {
  h5::Handle file;
};

RestartReader::RestartReader(const std::filesystem::path& file, const std::string& scene,
                             const DescribeDifference& describe_difference)
    : _state(std::make_unique<State>()) {
  check_seal(file, scene, describe_difference);
  _state->file = h5::open_file(file, false);
}

RestartReader::~RestartReader() = default;

double RestartReader::number(const std::string& name) const { return h5::read_number(_state->file, name); }

std::int64_t RestartReader::integer(const std::string& name) const {
  return h5::read_integer(_state->file, name);
}

std::string RestartReader::text(const std::string& name) const { return h5::read_text(_state->file, name); }

std::uint64_t RestartReader::size(const std::string& name) const {
  return h5::shape(h5::open_dataset(_state->file, name)).at(0);
}

void RestartReader::read(const std::string& name, std::uint64_t first, std::span<double> values) const {
  h5::read(h5::open_dataset(_state->file, name), first, values);
}

}  // namespace drogue::run
