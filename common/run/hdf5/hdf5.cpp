#include "common/run/hdf5/hdf5.hpp"

#include <algorithm>
#include <utility>

#include "common/run/files/io_error.hpp"
#include "common/run/hdf5/hdf5_call.hpp"

namespace drogue::run::h5 {
namespace {

Handle checked(hid_t id, herr_t (*close)(hid_t), const char* action, hid_t parent) {
  if (id < 0) fail(action, parent);
  return {id, close};
}

/// File access: without file locks (the run directory has one, and a viewer must not stop a run), and with
/// metadata in memory until the file is closed, so that a kill within a step keeps the former content.
Handle file_access(const std::filesystem::path& path) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (!access) fail("prepare to open", path);
#if H5_VERSION_GE(1, 10, 7) && !(H5_VERS_MINOR == 12 && H5_VERS_RELEASE == 0)
  H5Pset_file_locking(access.id(), false, true);
#endif
  // Closing the file closes all objects in it.
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  // One write changes a group of the format of HDF5 1.8; later formats mark a file that a kill left open.
  if (H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18) < 0) fail("prepare to open", path);
  H5AC_cache_config_t cache = {};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  herr_t status = H5Pget_mdc_config(access.id(), &cache);
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  if (status >= 0) status = H5Pset_mdc_config(access.id(), &cache);
  if (status < 0) fail("prepare to open", path);
  return access;
}

/// The rows [first, first + count) of `dataset`, flat entry numbers, as a selection of its file space.
Handle select_rows(const Handle& dataset, std::uint64_t first, std::uint64_t count) {
  std::vector<hsize_t> extent;
  for (const std::uint64_t n : shape(dataset)) extent.push_back(n);
  hsize_t row = 1;
  for (std::size_t i = 1; i < extent.size(); ++i) row *= extent[i];
  const bool whole = row > 0 && first % row == 0 && count % row == 0;
  if (!whole || extent.empty() || (first + count) / row > extent[0]) {
    throw Failure(ExitCode::io_error, "a piece of a dataset must be whole rows within it");
  }
  std::vector<hsize_t> start(extent.size(), 0);
  start[0] = first / row;
  extent[0] = count / row;
  Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "access", dataset.id());
  if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0) {
    fail("access", dataset.id());
  }
  return space;
}

/// As `select_rows`, of a dataset with one dimension.
Handle select_blocks(const Handle& dataset, const Blocks& blocks, std::size_t entries) {
  const hsize_t first = blocks.first, length = blocks.length, count = blocks.count, stride = blocks.stride;
  const std::vector<std::uint64_t> extent = shape(dataset);
  if (extent.size() != 1 || length * count != entries || first + (count - 1) * stride + length > extent[0])
    throw Failure(ExitCode::io_error, "blocks of a dataset must be within it");
  Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "access", dataset.id());
  if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &first, &stride, &count, &length) < 0)
    fail("access", dataset.id());
  return space;
}

Handle memory_space(const Handle& dataset, std::size_t count) {
  const hsize_t size = count;
  return checked(H5Screate_simple(1, &size, nullptr), H5Sclose, "access", dataset.id());
}

void write_values(const Handle& dataset, hid_t type, std::uint64_t first, const void* values,
                  std::size_t count) {
  const Lock lock;
  if (count == 0) return;
  const Handle selection = select_rows(dataset, first, count);
  const Handle memory = memory_space(dataset, count);
  if (H5Dwrite(dataset.id(), type, memory.id(), selection.id(), H5P_DEFAULT, values) < 0)
    fail("write", dataset.id());
}

}  // namespace

Handle::Handle(Handle&& other) noexcept : _id(std::exchange(other._id, -1)), _close(other._close) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    reset();
    _id = std::exchange(other._id, -1);
    _close = other._close;
  }
  return *this;
}

void Handle::reset() noexcept {
  if (_id < 0) return;
  const Lock lock;
  _close(std::exchange(_id, -1));
}

void Handle::close_file() {
  const Lock lock;
  flush(*this);  // reports a full disk while the file still has its name; H5Fclose would lose it
  const hid_t id = std::exchange(_id, -1);
  if (H5Fclose(id) < 0) throw Failure(ExitCode::io_error, "cannot close an HDF5 file");
}

Handle create_file(const std::filesystem::path& path, std::uint64_t user_block) {
  const Lock lock;
  const Handle access = file_access(path);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // Equal content has equal bytes, whenever it is written: the root group has no times, as other objects.
  if (!creation || H5Pset_userblock(creation.id(), user_block) < 0 ||
      H5Pset_obj_track_times(creation.id(), false) < 0)
    fail("create", path);
  // The operating system writes whole pages, even if the process is killed. HDF5 aligns to pages only without
  // a user block.
  if (user_block == 0 && H5Pset_alignment(access.id(), index_page - 256, index_page) < 0)
    fail("create", path);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (id < 0) fail("create", path);
  return {id, H5Fclose};
}

Handle open_file(const std::filesystem::path& path, bool writable) {
  const Lock lock;
  const Handle access = file_access(path);
  const hid_t id = H5Fopen(path.c_str(), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access.id());
  if (id < 0) fail("open", path);
  return {id, H5Fclose};
}

Handle create_group(const Handle& parent, const std::string& name, unsigned links, unsigned name_length) {
  const Lock lock;
  const Handle creation = checked(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "write", parent.id());
  H5Pset_obj_track_times(creation.id(), false);
  if (links > 0 && (H5Pset_est_link_info(creation.id(), links, name_length) < 0 ||
                    H5Pset_link_phase_change(creation.id(), 65535, 65534) < 0))
    fail("write", parent.id());
  const hid_t id = name.empty()
                       ? H5Gcreate_anon(parent.id(), creation.id(), H5P_DEFAULT)
                       : H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT);
  return checked(id, H5Gclose, "write", parent.id());
}

void link(const Handle& parent, const std::string& name, const Handle& object) {
  const Lock lock;
  if (H5Olink(object.id(), parent.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0)
    fail("write", parent.id());
}

void flush(const Handle& file) {
  const Lock lock;
  if (H5Fflush(file.id(), H5F_SCOPE_GLOBAL) < 0) fail("write", file.id());
}

void flush_object(const Handle& object) {
  const Lock lock;
  if (H5Oflush(object.id()) < 0) fail("write", object.id());
}

void keep_length(const Handle& file) {
  const Lock lock;
  if (H5Fincrement_filesize(file.id(), 0) < 0) fail("write", file.id());
}

Handle open_group(const Handle& parent, const std::string& name) {
  const Lock lock;
  return checked(H5Gopen2(parent.id(), name.c_str(), H5P_DEFAULT), H5Gclose, "read", parent.id());
}

bool exists(const Handle& parent, const std::string& name) {
  const Lock lock;
  return H5Lexists(parent.id(), name.c_str(), H5P_DEFAULT) > 0;
}

void remove(const Handle& parent, const std::string& name) {
  const Lock lock;
  if (H5Ldelete(parent.id(), name.c_str(), H5P_DEFAULT) < 0) fail("change", parent.id());
}

void move(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name) {
  const Lock lock;
  if (H5Lmove(from.id(), name.c_str(), to.id(), new_name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0)
    fail("change", from.id());
}

std::vector<std::string> children(const Handle& group) {
  const Lock lock;
  std::vector<std::string> names;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names) < 0)
    fail("read", group.id());
  return names;
}

Handle create_dataset(const Handle& parent, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape) {
  const Lock lock;
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const Handle space = checked(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr),
                               H5Sclose, "write", parent.id());
  const Handle creation = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "write", parent.id());
  H5Pset_obj_track_times(creation.id(), false);
  H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  const hid_t id = name.empty() ? H5Dcreate_anon(parent.id(), type, space.id(), creation.id(), H5P_DEFAULT)
                                : H5Dcreate2(parent.id(), name.c_str(), type, space.id(), H5P_DEFAULT,
                                             creation.id(), H5P_DEFAULT);
  return checked(id, H5Dclose, "write", parent.id());
}

Handle open_dataset(const Handle& parent, const std::string& name) {
  const Lock lock;
  return checked(H5Dopen2(parent.id(), name.c_str(), H5P_DEFAULT), H5Dclose, "read", parent.id());
}

std::uint64_t offset(const Handle& dataset) {
  const Lock lock;
  const haddr_t place = H5Dget_offset(dataset.id());
  if (place == HADDR_UNDEF) fail("write", dataset.id());
  return place;
}

std::vector<std::uint64_t> shape(const Handle& dataset) {
  const Lock lock;
  const Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, "read", dataset.id());
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id()))));
  H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

void write(const Handle& dataset, std::uint64_t first, std::span<const double> values) {
  write_values(dataset, H5T_NATIVE_DOUBLE, first, values.data(), values.size());
}

void write(const Handle& dataset, std::uint64_t first, std::span<const std::int64_t> values) {
  write_values(dataset, H5T_NATIVE_INT64, first, values.data(), values.size());
}

void write(const Handle& dataset, const Blocks& blocks, std::span<const double> values) {
  const Lock lock;
  const Handle selection = select_blocks(dataset, blocks, values.size());
  const Handle memory = memory_space(dataset, values.size());
  if (H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), selection.id(), H5P_DEFAULT, values.data()) < 0)
    fail("write", dataset.id());
}

void read(const Handle& dataset, const Blocks& blocks, std::span<double> values) {
  const Lock lock;
  if (values.empty()) return;
  const Handle selection = select_blocks(dataset, blocks, values.size());
  const Handle memory = memory_space(dataset, values.size());
  if (H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), selection.id(), H5P_DEFAULT, values.data()) < 0) {
    fail("read", dataset.id());
  }
}

}  // namespace drogue::run::h5
