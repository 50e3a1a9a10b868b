#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "common/run/hdf5/blocks.hpp"

namespace drogue::run::h5 {

/// The little of HDF5 that run directories need. Every call may be made from any thread (the library itself
/// is usually built without threads, so a lock serialises them), prints nothing, and throws
/// Failure(io_error).

/// An open file, group or dataset.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : _id(id), _close(close) {}
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  ~Handle() { reset(); }

  [[nodiscard]] hid_t id() const noexcept { return _id; }
  explicit operator bool() const noexcept { return _id >= 0; }

  /// Closes the object and ignores errors.
  void reset() noexcept;

  /// Flushes and closes a file. Throws `Failure` (io_error).
  void close_file();

 private:
  hid_t _id = -1;
  herr_t (*_close)(hid_t) = nullptr;
};

constexpr std::uint64_t index_page = 4096;  ///< bytes that the system writes whole

/// Creates a file with `user_block` free bytes at its begin: 0, or a power of two from 512. Without a user
/// block, allocations of about an index_page and more are aligned to pages until the file is closed.
Handle create_file(const std::filesystem::path& path, std::uint64_t user_block = 0);
Handle open_file(const std::filesystem::path& path, bool writable);

/// Creates a group. With `links` it holds that many names of `name_length` bytes in one block, so that adding
/// a name is one write. With an empty name the group stays unreachable until `link`; closed without a name it
/// vanishes.
Handle create_group(const Handle& parent, const std::string& name, unsigned links = 0,
                    unsigned name_length = 0);
void link(const Handle& parent, const std::string& name, const Handle& object);

/// Flushes the file to the operating system.
void flush(const Handle& file);

/// Flushes the header of one object only.
void flush_object(const Handle& object);

/// Keeps the length of a file after a removal. HDF5 would otherwise truncate the file before it writes the
/// new length, and leave it unreadable in between.
void keep_length(const Handle& file);

Handle open_group(const Handle& parent, const std::string& name);
bool exists(const Handle& parent, const std::string& name);
void remove(const Handle& parent, const std::string& name);
void move(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name);

/// Names of the members of a group, ascending.
std::vector<std::string> children(const Handle& group);

/// Creates a contiguous dataset with its space allocated; with an empty name it stays unreachable until
/// `link`. `type` is H5T_NATIVE_DOUBLE or H5T_NATIVE_INT64.
Handle create_dataset(const Handle& parent, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape);
Handle open_dataset(const Handle& parent, const std::string& name);
std::vector<std::uint64_t> shape(const Handle& dataset);

/// Place of the numbers of a dataset in its file, bytes.
std::uint64_t offset(const Handle& dataset);

/// Entries [first, first + values.size()) in row-major order, whole rows of the first dimension.
void write(const Handle& dataset, std::uint64_t first, std::span<const double> values);
void write(const Handle& dataset, std::uint64_t first, std::span<const std::int64_t> values);

/// All entries of blocks of a dataset with one dimension.
void write(const Handle& dataset, const Blocks& blocks, std::span<const double> values);
void read(const Handle& dataset, const Blocks& blocks, std::span<double> values);

void write_attribute(const Handle& object, const std::string& name, double value);
void write_attribute(const Handle& object, const std::string& name, std::int64_t value);
void write_attribute(const Handle& object, const std::string& name, const std::string& value);
bool has_attribute(const Handle& object, const std::string& name);
double read_number(const Handle& object, const std::string& name);
std::int64_t read_integer(const Handle& object, const std::string& name);
std::string read_text(const Handle& object, const std::string& name);

}  // namespace drogue::run::h5
