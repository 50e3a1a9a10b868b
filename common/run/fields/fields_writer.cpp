#include "common/run/fields/fields_writer.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/run/fields/xdmf.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/io_error.hpp"
#include "common/run/hdf5/hdf5.hpp"

namespace drogue::run {
namespace {

constexpr std::uint64_t piece_entries = 1U << 18U;
constexpr std::uint64_t metadata_bytes =
    1U << 14U;  ///< upper bound of what a group or a dataset adds to its data

// Number of names per index block: of /mesh, of /steps at first (one page), and of /steps of a long run.
constexpr unsigned mesh_links = 16, page_links = 190, many_links = 3000;
constexpr unsigned mesh_name_length = 16, step_name_length = 6;

/// Reserves disk space behind the end of the file without changing its length.
void reserve(const std::filesystem::path& file, std::uint64_t bytes) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) throw io_failure("write", file, errno);
  const off_t end = lseek(descriptor, 0, SEEK_END);
  const int status = fallocate(descriptor, FALLOC_FL_KEEP_SIZE, end, static_cast<off_t>(bytes));
  int error = status == 0 ? 0 : errno;
  // fallocate does not check a limit on the file length (ulimit -f) if the length does not change.
  struct rlimit limit = {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && static_cast<rlim_t>(end) + bytes > limit.rlim_cur)
    error = EFBIG;
  close(descriptor);
  // Other file systems, say NFS, report a full disk while writing; end_step() is not reached then.
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) throw io_failure("write", file, error);
}

/// Times of the outputs of a file, s, and that at which a continued run began it; before all time if none
/// did.
struct WrittenTimes {
  std::set<double> times;
  double begins_after = -std::numeric_limits<double>::infinity();
};

WrittenTimes written_times(const std::filesystem::path& file) {
  const h5::Handle handle = h5::open_file(file, false);
  const h5::Handle index = h5::open_group(handle, "steps");
  WrittenTimes written;
  for (const std::string& name : h5::children(index))
    written.times.insert(h5::read_number(h5::open_group(index, name), "time"));
  if (h5::has_attribute(handle, "begins_after"))
    written.begins_after = h5::read_number(handle, "begins_after");
  return written;
}

h5::Handle create_described(const h5::Handle& parent, const std::string& name, const DatasetSpec& spec,
                            hid_t type) {
  h5::Handle dataset = h5::create_dataset(parent, name, type, spec.shape);
  h5::write_attribute(dataset, "units", spec.units);
  h5::write_attribute(dataset, "centering", spec.centering);
  h5::write_attribute(dataset, "description", spec.description);
  return dataset;
}

}  // namespace

struct FieldsWriter::State {
  std::filesystem::path file;
  std::filesystem::path xdmf;
  std::string title;
  std::vector<DatasetSpec> fields;
  std::vector<DatasetSpec> mesh;
  std::vector<OutputStep> outputs;
  OutputStep current;
  // Between begin_step() and end_step() only:
  h5::Handle open;
  h5::Handle step;  // unnamed
  std::map<std::string, h5::Handle, std::less<>> datasets;

  void create(std::optional<double> begins_after) const;
  void resume(double time);
  void require_same_fields(const h5::Handle& output) const;
  [[nodiscard]] std::set<std::string> named_grids() const;
  [[nodiscard]] std::vector<GridDatasets> grids() const;
  void write_xdmf() const;
  void abandon_step() noexcept;
  void publish(h5::Handle file, const std::string& group, const std::string& name,
               const h5::Handle& object) const;
  void enlarge_index() const;

  template <typename Number>
  void add_mesh(const DatasetSpec& spec, hid_t type,
                const std::function<void(std::uint64_t, std::span<Number>)>& source);
};

void FieldsWriter::State::create(std::optional<double> begins_after) const {
  const std::filesystem::path temporary = temporary_name(file);
  try {
    h5::Handle handle = h5::create_file(temporary);
    const h5::Handle all = h5::create_group(handle, "mesh", mesh_links, mesh_name_length);
    for (const std::string& grid : named_grids()) h5::create_group(all, grid, mesh_links, mesh_name_length);
    h5::create_group(handle, "steps", page_links, step_name_length);
    if (begins_after) h5::write_attribute(handle, "begins_after", *begins_after);
    handle.close_file();
  } catch (...) {
    unlink(temporary.c_str());
    throw;
  }
  replace_file(temporary, file);
}

void FieldsWriter::State::resume(double time) {
  h5::Handle handle = h5::open_file(file, true);
  const h5::Handle index = h5::open_group(handle, "steps");
  bool dropped = false;
  for (const std::string& name : h5::children(index)) {
    const h5::Handle output = h5::open_group(index, name);
    const double output_time = h5::read_number(output, "time");
    if (output_time <= time) {
      require_same_fields(output);
      outputs.push_back({name, output_time});
    } else {
      h5::remove(index, name);
      dropped = true;
    }
  }
  if (dropped) h5::keep_length(handle);
  handle.close_file();
}

/// fields.xdmf lists the same fields for every step.
void FieldsWriter::State::require_same_fields(const h5::Handle& output) const {
  const std::set<std::string> grids = named_grids();
  std::set<std::string> wanted, found;
  for (const DatasetSpec& field : fields) wanted.insert(path_of(field));
  for (const std::string& name : h5::children(output)) {
    if (!grids.contains(name))
      found.insert(name);
    else
      for (const std::string& field : h5::children(h5::open_group(output, name)))
        found.insert(name + "/" + field);
  }
  if (found != wanted)
    throw Failure(ExitCode::io_error,
                  "cannot continue '" + file.string() + "': it has other fields than this run");
}

/// Names of the grids beside the main one, ascending.
std::set<std::string> FieldsWriter::State::named_grids() const {
  std::set<std::string> names;
  for (const DatasetSpec& field : fields)
    if (!field.grid.empty()) names.insert(field.grid);
  return names;
}

std::vector<GridDatasets> FieldsWriter::State::grids() const {
  std::set<std::string> names = named_grids();
  for (const auto* specs : {&mesh, &fields})
    for (const DatasetSpec& spec : *specs) names.insert(spec.grid);
  std::vector<GridDatasets> all;
  for (const std::string& name : names) {
    GridDatasets& grid = all.emplace_back();
    grid.name = name;
    const auto belongs = [&](const DatasetSpec& spec) { return spec.grid == name; };
    std::ranges::copy_if(mesh, std::back_inserter(grid.mesh), belongs);
    std::ranges::copy_if(fields, std::back_inserter(grid.fields), belongs);
  }
  return all;
}

/// Writes fields.xdmf once the mesh of every grid is complete.
void FieldsWriter::State::write_xdmf() const {
  const std::vector<GridDatasets> all = grids();
  if (std::ranges::all_of(all, [](const GridDatasets& grid) { return is_complete(grid.mesh); }))
    write_file_atomically(xdmf, xdmf_document(title, all, outputs));
}

/// Closes the unnamed group of a step, which removes it from the file.
void FieldsWriter::State::abandon_step() noexcept {
  datasets.clear();
  step.reset();
  open.reset();
}

/// Links the complete `object` into the file and closes the file. The object is on disk before the link,
/// which is one write, so that a kill at any moment leaves a valid file.
void FieldsWriter::State::publish(h5::Handle handle, const std::string& group, const std::string& name,
                                  const h5::Handle& object) const {
  h5::flush(handle);
  sync_path(file);
  const h5::Handle parent = h5::open_group(handle, group);
  if (h5::exists(parent, name)) h5::remove(parent, name);
  h5::link(parent, name, object);
  handle.close_file();
  sync_path(file);
}

/// Replaces /steps by a group with room for more names. The new group is complete on disk before one write of
/// the root group links it.
void FieldsWriter::State::enlarge_index() const {
  reserve(file, 32ULL * many_links);
  h5::Handle handle = h5::open_file(file, true);
  h5::Handle roomy = h5::create_group(handle, "", many_links, step_name_length);
  h5::flush(handle);
  h5::link(handle, "roomy", roomy);
  roomy = h5::open_group(handle, "roomy");  // HDF5 cannot move links to an unnamed group
  h5::Handle index = h5::open_group(handle, "steps");
  for (const OutputStep& output : outputs) h5::move(index, output.group, roomy, output.group);
  h5::flush_object(roomy);
  sync_path(file);
  index.reset();
  h5::remove(handle, "steps");
  h5::move(handle, "roomy", handle, "steps");
  handle.close_file();
  sync_path(file);
}

template <typename Number>
void FieldsWriter::State::add_mesh(const DatasetSpec& spec, hid_t type,
                                   const std::function<void(std::uint64_t, std::span<Number>)>& source) {
  reserve(file, entries(spec) * sizeof(Number) + metadata_bytes);
  h5::Handle handle = h5::open_file(file, true);
  mesh.push_back(spec);
  const std::string group = spec.grid.empty() ? "mesh" : "mesh/" + spec.grid;
  // Only grids with fields have a group from the start.
  if (!spec.grid.empty() && !h5::exists(h5::open_group(handle, "mesh"), spec.grid)) {
    {
      const h5::Handle grid = h5::create_group(handle, "", mesh_links, mesh_name_length);
      publish(std::move(handle), "mesh", spec.grid, grid);
    }
    handle = h5::open_file(file, true);
  }
  if (h5::exists(h5::open_group(handle, group), spec.name)) return;
  const h5::Handle dataset = create_described(handle, "", spec, type);
  const std::uint64_t total = entries(spec);
  const std::uint64_t row = std::max<std::uint64_t>(1, total / std::max<std::uint64_t>(1, spec.shape.at(0)));
  const std::uint64_t piece = std::max<std::uint64_t>(1, piece_entries / row) * row;
  std::vector<Number> values(std::min(piece, total));
  for (std::uint64_t first = 0; first < total; first += piece) {
    const std::span<Number> part(values.data(), std::min(piece, total - first));
    source(first, part);
    h5::write(dataset, first, std::span<const Number>(part));
  }
  publish(std::move(handle), group, spec.name, dataset);
}

FieldsWriter::FieldsWriter(const std::filesystem::path& directory, std::string title,
                           std::vector<DatasetSpec> fields, std::optional<double> resume_time)
    : _state(std::make_unique<State>()) {
  _state->file = directory / "fields.h5";
  _state->xdmf = directory / "fields.xdmf";
  _state->title = std::move(title);
  _state->fields = std::move(fields);
  if (resume_time && std::filesystem::exists(_state->file)) {
    _state->resume(*resume_time);
  } else {
    _state->create(resume_time);
  }
}

void FieldsWriter::require_same_fields(const std::filesystem::path& directory,
                                       const std::vector<DatasetSpec>& fields, double resume_time) {
  State state;
  state.file = directory / "fields.h5";
  state.fields = fields;
  if (!std::filesystem::exists(state.file)) return;
  const h5::Handle handle = h5::open_file(state.file, true);  // which a reader's lock refuses
  const h5::Handle index = h5::open_group(handle, "steps");
  for (const std::string& name : h5::children(index)) {
    const h5::Handle output = h5::open_group(index, name);
    if (h5::read_number(output, "time") <= resume_time) state.require_same_fields(output);
  }
}

std::vector<double> FieldsWriter::missing_times(const std::filesystem::path& directory,
                                                const std::filesystem::path& former,
                                                const std::vector<double>& times, double resume_time) {
  std::error_code absent;
  const bool is_here = std::filesystem::equivalent(directory, former, absent);
  const std::filesystem::path own = directory / "fields.h5", other = former / "fields.h5";
  WrittenTimes written;
  for (const std::filesystem::path& file : {own, other}) {
    if (!std::filesystem::exists(file)) continue;
    const WrittenTimes found = written_times(file);
    written.times.insert(found.times.begin(), found.times.end());
    written.begins_after = std::max(written.begins_after, found.begins_after);
  }
  if (!is_here && !std::filesystem::exists(other)) return {};
  std::vector<double> missing;
  for (const double time : times)
    if (time > written.begins_after && time <= resume_time && !written.times.contains(time))
      missing.push_back(time);
  return missing;
}

FieldsWriter::~FieldsWriter() { _state->abandon_step(); }

void FieldsWriter::add_mesh(const DatasetSpec& spec, const Source& source) {
  _state->add_mesh<double>(spec, H5T_NATIVE_DOUBLE, source);
  // Coordinates of further axes may follow.
  if (std::ranges::all_of(_state->grids(), fields_fit)) _state->write_xdmf();
}

void FieldsWriter::add_mesh(const DatasetSpec& spec, const IntegerSource& source) {
  _state->add_mesh<std::int64_t>(spec, H5T_NATIVE_INT64, source);
}

void FieldsWriter::begin_step(double time, std::int64_t step) {
  if (_state->outputs.size() == page_links) _state->enlarge_index();
  std::uint64_t bytes = metadata_bytes;
  for (const DatasetSpec& field : _state->fields) bytes += entries(field) * sizeof(double) + metadata_bytes;
  reserve(_state->file, bytes);
  char name[32];
  std::snprintf(name, sizeof name, "%06zu", _state->outputs.size());
  _state->current = {name, time};
  _state->open = h5::open_file(_state->file, true);
  try {
    _state->step = h5::create_group(_state->open, "");
    h5::write_attribute(_state->step, "time", time);
    h5::write_attribute(_state->step, "step", step);
    std::map<std::string, h5::Handle> groups;
    for (const std::string& grid : _state->named_grids()) groups[grid] = h5::create_group(_state->step, grid);
    for (const DatasetSpec& field : _state->fields) {
      const h5::Handle& group = field.grid.empty() ? _state->step : groups.at(field.grid);
      _state->datasets[path_of(field)] = create_described(group, field.name, field, H5T_NATIVE_DOUBLE);
    }
  } catch (...) {
    _state->abandon_step();
    throw;
  }
}

void FieldsWriter::write(std::string_view field, std::uint64_t first, std::span<const double> values) {
  try {
    h5::write(_state->datasets.find(field)->second, first, values);
  } catch (...) {
    _state->abandon_step();
    throw;
  }
}

FieldPlace FieldsWriter::place(std::string_view field) const {
  return {_state->file, h5::offset(_state->datasets.find(field)->second)};
}

void FieldsWriter::end_step() {
  _state->datasets.clear();
  _state->publish(std::move(_state->open), "steps", _state->current.group, _state->step);
  _state->step.reset();
  _state->outputs.push_back(_state->current);
  _state->write_xdmf();
}

void FieldsWriter::add_reference(const ReferenceSolution& solution) {
  std::uint64_t bytes = metadata_bytes;
  for (const auto& [spec, values] : solution.datasets) bytes += values.size_bytes() + metadata_bytes;
  reserve(_state->file, bytes);
  h5::Handle handle = h5::open_file(_state->file, true);
  const h5::Handle group = h5::create_group(handle, "");
  h5::write_attribute(group, "scheme", solution.scheme);
  h5::write_attribute(group, "cells", static_cast<std::int64_t>(entries(solution.datasets.at(0).first)));
  for (const auto& [spec, values] : solution.datasets)
    h5::write(create_described(group, spec.name, spec, H5T_NATIVE_DOUBLE), 0, values);
  _state->publish(std::move(handle), "/", "reference", group);
}

std::size_t FieldsWriter::steps() const noexcept { return _state->outputs.size(); }

}  // namespace drogue::run
