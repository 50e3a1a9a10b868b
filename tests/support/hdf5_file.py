"""Reads HDF5 files of a run through the HDF5 library of drogue-gas, because plain Python has no reader."""

import array
import ctypes
import functools
import subprocess

NAME, INCREASING = 0, 0  # H5_INDEX_NAME, H5_ITER_INC
GROUP = 2  # H5I_type_t
FLOAT, STRING = 1, 3  # H5T_class_t
ID = ctypes.c_int64


class GroupInfo(ctypes.Structure):
    _fields_ = [("storage", ctypes.c_int), ("links", ctypes.c_uint64), ("order", ctypes.c_int64),
                ("mounted", ctypes.c_bool)]


@functools.cache
def library(program):
    """HDF5 library that the loader finds for `program`."""
    lines = subprocess.run(["ldd", str(program)], capture_output=True, text=True, check=True).stdout.splitlines()
    path = next(line.split()[2] for line in lines if "libhdf5" in line and "=>" in line)
    hdf5 = ctypes.CDLL(path, mode=ctypes.RTLD_GLOBAL)
    for name in ("H5Fopen", "H5Oopen", "H5Gopen2", "H5Dget_space", "H5Dget_type", "H5Aget_type", "H5Aget_space",
                 "H5Aopen_by_idx"):
        getattr(hdf5, name).restype = ID
    for name in ("H5Lget_name_by_idx", "H5Aget_name"):
        getattr(hdf5, name).restype = ctypes.c_ssize_t
    hdf5.H5Sget_simple_extent_npoints.restype = ctypes.c_int64
    hdf5.H5Tget_size.restype = ctypes.c_size_t
    hdf5.H5open()
    hdf5.H5Eset_auto2(ID(0), None, None)  # suppresses error stacks on stderr: a failed call raises here
    return hdf5


class Hdf5File:
    """Content of a small file: `datasets` maps a path to the bytes of its values, `attributes` a path (of a
    group or a dataset) to {name: str or float or int}."""

    def __init__(self, program, path):
        self._library = library(program)
        self.datasets = {}
        self.attributes = {}
        file = self._library.H5Fopen(str(path).encode(), 0, ID(0))
        if file < 0:
            raise OSError(f"{path} is not a readable HDF5 file")
        try:
            root = self._library.H5Oopen(ID(file), b"/", ID(0))
            self.attributes["/"] = self._read_attributes(root)
            self._visit(root, "")
            self._library.H5Oclose(ID(root))
        finally:
            self._library.H5Fclose(ID(file))

    def values(self, path):
        """FP64 numbers of a dataset."""
        return array.array("d", self.datasets[path])

    def children(self, group):
        """Sorted names of the members of a group."""
        start = group.rstrip("/") + "/"
        paths = [*self.datasets, *self.attributes]
        return sorted({path[len(start):].split("/")[0] for path in paths if path.startswith(start)})

    def _visit(self, place, path):
        info = GroupInfo()
        if self._library.H5Gget_info(ID(place), ctypes.byref(info)) < 0:
            raise OSError(f"group {path or '/'} cannot be read")
        for index in range(info.links):
            name = self._text(lambda buffer, size, i=index: self._library.H5Lget_name_by_idx(
                ID(place), b".", NAME, INCREASING, ctypes.c_uint64(i), buffer, ctypes.c_size_t(size), ID(0)))
            child = self._library.H5Oopen(ID(place), name.encode(), ID(0))
            if child < 0:
                raise OSError(f"{path}/{name} cannot be read")
            full = f"{path}/{name}"
            self.attributes[full] = self._read_attributes(child)
            if self._library.H5Iget_type(ID(child)) == GROUP:
                self._visit(child, full)
            else:
                self.datasets[full] = self._read_dataset(child, full)
            self._library.H5Oclose(ID(child))

    @staticmethod
    def _text(call):
        buffer = ctypes.create_string_buffer(1024)
        if call(buffer, 1024) < 0:
            raise OSError("a name cannot be read")
        return buffer.value.decode()

    def _read_dataset(self, dataset, path):
        kind = ID(self._library.H5Dget_type(ID(dataset)))
        space = ID(self._library.H5Dget_space(ID(dataset)))
        count = self._library.H5Sget_simple_extent_npoints(space)
        buffer = ctypes.create_string_buffer(count * self._library.H5Tget_size(kind))
        if self._library.H5Dread(ID(dataset), kind, ID(0), ID(0), ID(0), buffer) < 0:
            raise OSError(f"{path} cannot be read")
        self._library.H5Sclose(space)
        self._library.H5Tclose(kind)
        return buffer.raw

    def _read_attributes(self, place):
        found = {}
        for index in range(self._library.H5Aget_num_attrs(ID(place))):
            attribute = ID(self._library.H5Aopen_by_idx(ID(place), b".", NAME, INCREASING, ctypes.c_uint64(index),
                                                        ID(0), ID(0)))
            name = self._text(lambda buffer, size, a=attribute: self._library.H5Aget_name(
                a, ctypes.c_size_t(size), buffer))
            kind = ID(self._library.H5Aget_type(attribute))
            found[name] = self._attribute_value(attribute, kind)
            self._library.H5Tclose(kind)
            self._library.H5Aclose(attribute)
        return found

    def _attribute_value(self, attribute, kind):
        if self._library.H5Tis_variable_str(kind) > 0:
            text = ctypes.c_char_p()
            self._library.H5Aread(attribute, kind, ctypes.byref(text))
            return (text.value or b"").decode()
        buffer = ctypes.create_string_buffer(self._library.H5Tget_size(kind))
        if self._library.H5Aread(attribute, kind, buffer) < 0:
            raise OSError("an attribute cannot be read")
        kind_class = self._library.H5Tget_class(kind)
        if kind_class == STRING:
            return buffer.raw.split(b"\0")[0].decode()
        return array.array("d" if kind_class == FLOAT else "q", buffer.raw)[0]
