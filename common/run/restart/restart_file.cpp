#include "common/run/restart/restart_file.hpp"

#include <unistd.h>

#include <map>
#include <optional>
#include <utility>

#include "common/program/program.hpp"
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
  Communicator& communicator;
  std::filesystem::path target;
  std::filesystem::path temporary;
  std::string scene;
  h5::Handle file = {};
  std::map<std::string, h5::Handle> arrays = {};
  std::optional<Failure> failure = {};  ///< of rank 0 of several

  /// Other ranks go on until commit(), so that none waits for a rank 0 that has given up.
  template <class Action>
  void run_on_root(const Action& action) {
    if (communicator.size() == 1) return action();
    if (!communicator.is_root() || failure) return;
    try {
      action();
    } catch (...) {
      failure = current_failure();
    }
  }
};

RestartWriter::RestartWriter(const std::filesystem::path& file, const std::string& scene,
                             Communicator& communicator)
    : _state(new State{communicator, file, temporary_name(file), scene}) {
  _state->run_on_root([&] { _state->file = h5::create_file(_state->temporary, seal_bytes); });
}

RestartWriter::~RestartWriter() {
  if (!_state || !_state->communicator.is_root()) return;
  _state->arrays.clear();
  _state->file.reset();
  unlink(_state->temporary.c_str());
}

void RestartWriter::number(const std::string& name, double value) {
  _state->run_on_root([&] { h5::write_attribute(_state->file, name, value); });
}

void RestartWriter::integer(const std::string& name, std::int64_t value) {
  _state->run_on_root([&] { h5::write_attribute(_state->file, name, value); });
}

void RestartWriter::text(const std::string& name, const std::string& value) {
  _state->run_on_root([&] { h5::write_attribute(_state->file, name, value); });
}

void RestartWriter::array(const std::string& name, std::uint64_t size) {
  _state->run_on_root(
      [&] { _state->arrays[name] = h5::create_dataset(_state->file, name, H5T_NATIVE_DOUBLE, {size}); });
}

void RestartWriter::write(const std::string& name, std::uint64_t first, std::span<const double> values) {
  _state->run_on_root([&] { h5::write(_state->arrays.at(name), first, values); });
}

void RestartWriter::write(const std::string& name, const Blocks& blocks, std::span<const double> values) {
  _state->run_on_root([&] { h5::write(_state->arrays.at(name), blocks, values); });
}

void RestartWriter::commit() {
  _state->communicator.run_on_root([&] {
    if (_state->failure) throw Failure(*_state->failure);
    _state->arrays.clear();
    _state->file.close_file();
    write_seal(_state->temporary, _state->scene);
    replace_file(_state->temporary, _state->target);
  });
  _state.reset();
}

struct RestartReader::State {
  Communicator& communicator;
  h5::Handle file = {};

  template <class Read>
  auto read(const Read& read) const {
    decltype(read()) value{};
    communicator.run_collectively([&] { value = read(); });
    return value;
  }
};

RestartReader::RestartReader(const std::filesystem::path& file, const std::string& scene,
                             const DescribeDifference& describe_difference, Communicator& communicator)
    : _state(new State{communicator}) {
  communicator.run_on_root([&] { check_seal(file, scene, describe_difference); });
  communicator.run_collectively([&] { _state->file = h5::open_file(file, false); });
}

RestartReader::~RestartReader() = default;

double RestartReader::number(const std::string& name) const {
  return _state->read([&] { return h5::read_number(_state->file, name); });
}

std::int64_t RestartReader::integer(const std::string& name) const {
  return _state->read([&] { return h5::read_integer(_state->file, name); });
}

std::string RestartReader::text(const std::string& name) const {
  return _state->read([&] { return h5::read_text(_state->file, name); });
}

std::uint64_t RestartReader::size(const std::string& name) const {
  return _state->read([&] { return h5::shape(h5::open_dataset(_state->file, name)).at(0); });
}

void RestartReader::read(const std::string& name, std::uint64_t first, std::span<double> values) const {
  read(name, {first, values.size(), 1, values.size()}, values);
}

void RestartReader::read(const std::string& name, const Blocks& blocks, std::span<double> values) const {
  _state->communicator.run_collectively(
      [&] { h5::read(h5::open_dataset(_state->file, name), blocks, values); });
}

}  // namespace drogue::run
