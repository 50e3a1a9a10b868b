"""Uses of the standard library without its header, which headers compiled before would hide from the compiler."""

import re

from layers import includes

# Names of the precompiled headers of cmake/DrogueOptions.cmake, and of others that some of those bring with gcc.
NAMES = {
    "algorithm": "clamp copy copy_n copy_if count fill find find_if any_of all_of none_of max_element min_element minmax max min "
                 "replace replace_if sort stable_sort transform upper_bound lower_bound for_each minmax_element",
    "array": "array to_array",
    "cmath": "abs ceil cos exp floor fmod hypot isfinite isinf isnan lgamma llround log lround pow rint signbit sin sqrt tan asinh",
    "cstdint": "int64_t uint64_t int32_t uint32_t uint8_t uintmax_t",
    "filesystem": "filesystem",
    "functional": "function reference_wrapper less greater plus",
    "map": "map multimap",
    "memory": "unique_ptr shared_ptr weak_ptr make_unique make_shared",
    "optional": "optional nullopt make_optional",
    "span": "span as_bytes as_writable_bytes",
    "sstream": "ostringstream istringstream stringstream",
    "stdexcept": "invalid_argument out_of_range runtime_error logic_error",
    "string": "string to_string stoul stod",
    "string_view": "string_view",
    "utility": "move swap exchange pair forward",
    "variant": "variant visit get_if holds_alternative monostate",
    "vector": "vector",
    "bit": "bit_cast endian rotl countr_zero popcount",
    "charconv": "from_chars to_chars",
    "chrono": "chrono",
    "cstdio": "snprintf printf fprintf fputs fflush",
    "cstring": "memcpy memmove memcmp strerror",
    "deque": "deque",
    "exception": "exception_ptr current_exception rethrow_exception",
    "fstream": "ifstream ofstream",
    "iostream": "cout cerr",
    "iterator": "back_inserter",
    "limits": "numeric_limits",
    "numbers": "numbers",
    "numeric": "accumulate iota inner_product reduce",
    "set": "set",
    "system_error": "error_code errc generic_category system_error",
    "tuple": "tuple tie tuple_size_v tuple_cat",
    "type_traits": "is_same_v is_trivially_copyable_v conditional_t decay_t remove_const_t remove_reference_t is_void_v enable_if_t",
}
# Headers whose synopsis includes the other or declares what is looked for, so that they stand for it.
BRINGS = {
    "cmath": {"cstdlib"},
    "cstdint": {"bit", "hdf5.h"},
    "string": {"filesystem", "fstream", "iostream", "sstream", "stdexcept"},
    "string_view": {"filesystem", "string", "fstream", "iostream", "sstream", "stdexcept"},
    "iterator": {"vector", "string", "map", "set", "array", "deque", "list", "span"},
    "system_error": {"filesystem", "charconv"},
    "utility": {"algorithm", "array", "deque", "filesystem", "functional", "list", "map", "memory", "optional", "set", "span",
                "string", "tuple", "type_traits", "unordered_map", "variant", "vector"},
}
USE = re.compile(r"\bstd::(?:ranges::)?(\w+)")
HEADER_OF = {name: header for header, names in NAMES.items() for name in names.split()}


def reached(path, texts, seen=None):
    """Names of the standard and library headers that a file includes, itself or through own headers."""
    seen = set() if seen is None else seen
    seen.add(path)
    found = set()
    for own, name in includes(texts.get(path, "")):
        if not own:
            found.add(name)
        elif name not in seen:
            found |= reached(name, texts, seen)
    return found


def missing(path, texts):
    """Sentences, one per standard header that the file uses and does not reach. `texts`: all sources by name."""
    code = re.sub(r'//.*|"(?:[^"\\\n]|\\.)*"', "", texts[path])
    headers = reached(path, texts)
    used = {}
    for name in USE.findall(code):
        if name in HEADER_OF:
            used.setdefault(HEADER_OF[name], name)
    return [f"{path} uses std::{name} without <{header}>" for header, name in sorted(used.items())
            if header not in headers and not BRINGS.get(header, set()) & headers]
