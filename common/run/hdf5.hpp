#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <vector>

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

  /// Closes, errors ignored.
  void reset() noexcept;

  /// Closes a file: all that was written is handed to the system, or this throws.
  void close_file();

 private:
  hid_t _id = -1;
  herr_t (*_close)(hid_t) = nullptr;
};

constexpr std::uint64_t index_page = 4096;  ///< bytes that the system writes whole

/// A new file, `user_block` bytes (0, or a power of two from 512) left free at its begin. Without any, blocks
/// of nearly an index_page and more begin with a page until the file is closed.
Handle create_file(const std::filesystem::path& path, std::uint64_t user_block = 0);
Handle open_file(const std::filesystem::path& path, bool writable);

/// A group. With `links` it has room for so many names of `name_length` bytes in one block of the file, so
/// that naming something in it is one write. An empty name leaves the group without one until `link`: nothing
/// leads to it, and writing it changes nothing that a reader sees. Closed without a name it is gone.
Handle create_group(const Handle& parent, const std::string& name, unsigned links = 0,
                    unsigned name_length = 0);
void link(const Handle& parent, const std::string& name, const Handle& object);

/// Hands all that was written to the system, or throws.
void flush(const Handle& file);

/// The same for the header of one object: nothing else in the file changes.
void flush_object(const Handle& object);

/// What was removed is not cut off the end of the file: HDF5 would do so before it writes the new length into
/// the file, which nobody can read in between.
void keep_length(const Handle& file);

Handle open_group(const Handle& parent, const std::string& name);
bool exists(const Handle& parent, const std::string& name);
void remove(const Handle& parent, const std::string& name);
void move(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name);

/// Names of what is in a group, ascending.
std::vector<std::string> children(const Handle& group);

/// A contiguous dataset with its space allocated; an empty name leaves it without one until `link`. `type` is
/// H5T_NATIVE_DOUBLE or H5T_NATIVE_INT64.
Handle create_dataset(const Handle& parent, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape);
Handle open_dataset(const Handle& parent, const std::string& name);
std::vector<std::uint64_t> shape(const Handle& dataset);

/// Entries [first, first + values.size()) in row-major order, whole rows of the first dimension.
void write(const Handle& dataset, std::uint64_t first, std::span<const double> values);
void write(const Handle& dataset, std::uint64_t first, std::span<const std::int64_t> values);
void read(const Handle& dataset, std::uint64_t first, std::span<double> values);

void write_attribute(const Handle& object, const std::string& name, double value);
void write_attribute(const Handle& object, const std::string& name, std::int64_t value);
void write_attribute(const Handle& object, const std::string& name, const std::string& value);
double read_number(const Handle& object, const std::string& name);
std::int64_t read_integer(const Handle& object, const std::string& name);
std::string read_text(const Handle& object, const std::string& name);

}  // namespace drogue::run::h5
