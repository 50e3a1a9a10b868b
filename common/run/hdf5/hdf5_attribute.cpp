#include "common/run/hdf5/hdf5.hpp"
#include "common/run/hdf5/hdf5_call.hpp"

namespace drogue::run::h5 {
namespace {

void write_scalar(const Handle& object, const std::string& name, hid_t type, const void* value) {
  const Lock lock;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute || H5Awrite(attribute.id(), type, value) < 0) fail("write", object.id());
}

void read_scalar(const Handle& object, const std::string& name, hid_t type, void* value) {
  const Lock lock;
  const Handle attribute(H5Aopen(object.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute || H5Aread(attribute.id(), type, value) < 0) fail("read '" + name + "' of", object.id());
}

/// UTF-8 text of variable length, which Python reads as str.
Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

}  // namespace

void write_attribute(const Handle& object, const std::string& name, double value) {
  const Lock lock;
  write_scalar(object, name, H5T_NATIVE_DOUBLE, &value);
}

void write_attribute(const Handle& object, const std::string& name, std::int64_t value) {
  const Lock lock;
  write_scalar(object, name, H5T_NATIVE_INT64, &value);
}

void write_attribute(const Handle& object, const std::string& name, const std::string& value) {
  const Lock lock;
  const char* text = value.c_str();
  write_scalar(object, name, text_type().id(), &text);
}

bool has_attribute(const Handle& object, const std::string& name) {
  const Lock lock;
  return H5Aexists(object.id(), name.c_str()) > 0;
}

double read_number(const Handle& object, const std::string& name) {
  const Lock lock;
  double value = 0.0;
  read_scalar(object, name, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t read_integer(const Handle& object, const std::string& name) {
  const Lock lock;
  std::int64_t value = 0;
  read_scalar(object, name, H5T_NATIVE_INT64, &value);
  return value;
}

std::string read_text(const Handle& object, const std::string& name) {
  const Lock lock;
  char* text = nullptr;
  read_scalar(object, name, text_type().id(), static_cast<void*>(&text));
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

}  // namespace drogue::run::h5
