"""Headers of other projects are precompiled, so that a compiler does not miss one: each file, or a header of ours that it
includes, includes what declares the names of the standard library and of these others that it uses."""
import functools
import pathlib
import re
import sys

from sources import INCLUDE, finish, list_code

# Names by their headers; a name of several is in each.
DECLARED = {
    "algorithm": """adjacent_find all_of any_of clamp copy copy_backward copy_if copy_n count count_if equal fill fill_n find
        find_if find_if_not is_sorted lower_bound max max_element min min_element minmax minmax_element mismatch
        next_permutation none_of nth_element partition remove_if replace replace_if reverse search shuffle sort stable_partition stable_sort
        swap_ranges transform unique upper_bound ranges""",
    "array": "array",
    "atomic": "atomic memory_order_acquire memory_order_relaxed memory_order_release memory_order_seq_cst",
    "bit": "bit_cast bit_ceil bit_floor bit_width countl_zero countr_one countr_zero endian has_single_bit popcount rotl",
    "cctype": "isalnum isalpha isdigit isspace isxdigit tolower toupper",
    "charconv": "from_chars from_chars_result to_chars",
    "chrono": "chrono",
    "concepts": "convertible_to same_as",
    "cmath": """abs acos asin atan atan2 cbrt ceil copysign cos exp exp2 fabs floor fma fmax fmin fmod frexp hypot ilogb isfinite
        isinf isnan isnormal ldexp log log10 log2 lround nanf nextafter pow round signbit sin sqrt tan trunc""",
    "compare": "partial_ordering",
    "complex": "complex conj norm polar",
    "concepts": "floating_point integral same_as",
    "condition_variable": "condition_variable",
    "csetjmp": "jmp_buf longjmp",
    "csignal": "sig_atomic_t signal",
    "cstddef": "byte ptrdiff_t",
    "cstdio": "clearerr fclose ferror fflush fgetc fopen fprintf fputs fread fseek ftell fwrite printf snprintf sscanf vsnprintf",
    "cstdlib": "abort abs aligned_alloc atoi exit free getenv malloc strtol strtoull",
    "cstring": "memcmp memcpy memset strcmp strerror strlen",
    "deque": "deque",
    "exception": "current_exception exception exception_ptr rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "fstream ifstream ofstream",
    "functional": "function greater hash less",
    "future": "async future future_status launch",
    "initializer_list": "initializer_list",
    "ios": "ios streamoff streamsize",
    "iosfwd": "istream ostream",
    "iostream": "cerr cin cout",
    "istream": "getline ios istream istreambuf_iterator streamoff streamsize",
    "iterator": "back_inserter distance istreambuf_iterator make_move_iterator next prev",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "make_shared make_unique owner_less shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock try_to_lock unique_lock",
    "new": "bad_alloc",
    "numbers": "numbers",
    "numeric": "accumulate gcd iota partial_sum reduce",
    "optional": "nullopt optional",
    "ostream": "endl flush ios ostream streamoff streamsize",
    "queue": "priority_queue queue",
    "random": "mt19937 mt19937_64 normal_distribution random_device uniform_int_distribution uniform_real_distribution",
    "regex": "regex regex_search smatch sregex_iterator",
    "set": "multiset set",
    "shared_mutex": "shared_lock shared_mutex",
    "span": "as_bytes as_writable_bytes span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "invalid_argument out_of_range runtime_error",
    "streambuf": "streambuf",
    "string": "getline stod stoi stoul string to_string u8string wstring",
    "string_view": "string_view",
    "system_error": "errc error_code generic_category system_error",
    "thread": "jthread this_thread thread",
    "tuple": "apply get tie tuple tuple_element_t",
    "type_traits": "conditional_t decay_t invoke_result_t is_arithmetic_v is_floating_point_v is_same_v is_trivially_copyable_v remove_reference_t type_identity_t",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility": "as_const declval exchange forward get in_place index_sequence make_index_sequence make_pair move pair swap",
    "variant": "get get_if holds_alternative monostate variant visit",
    "vector": "erase vector",
}
# Declared wherever there is a container, by the standard (range.access), or beside what they work on.
ANYWHERE = {"begin", "data", "empty", "end", "erase_if", "rbegin", "rend", "size"}
# What a header is bound to bring along, by its synopsis in the standard or as the class that it is about.
BRINGS = {
    "fstream": ["istream", "ostream"],
    "iostream": ["istream", "ostream"],
    "sstream": ["istream", "ostream"],
    "filesystem": ["system_error"],
    "map": ["utility"],
    "unordered_map": ["utility"],
    "system_error": ["stdexcept"],
    "string": ["string_view"],
}
# Names outside of std, and where they are declared.
OTHERS = {
    r"\b(?:INFINITY|NAN)\b": {"cmath"},
    r"\bu?int(?:8|16|32|64)_t\b": {"cstdint"},
    r"\bfmt::": {"fmt/format.h"},
    r"\bvk::": {"vulkan/vulkan.hpp", "vulkan/vulkan_raii.hpp"},
    r"\bnlohmann::": {"nlohmann/json.hpp", "nlohmann/json_fwd.hpp"},
    r"\bTEST(?:_[FP])?\(|\btesting::|\b(?:EXPECT|ASSERT)_[A-Z]+\(": {"gtest/gtest.h"},
}

NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
USED = re.compile(r"\bstd::([a-z_0-9]+)")


def find_headers():
    """The headers that declare each name."""
    headers = {}
    for header, names in DECLARED.items():
        for name in names.split():
            headers.setdefault(name, set()).add(header)
    return headers


def describe(place, name, headers):
    return f"{place}: {name} needs <{'> or <'.join(sorted(headers))}>"


def is_part(file):
    """Of whoever includes it: inside a namespace, or several times, after what it needs."""
    return "/formulas/" in str(file) or "/vulkan/layout/" in str(file) or "/lab/walks/" in str(file) or file.name.endswith("-inl.h")


@functools.lru_cache(maxsize=None)
def find_used(file):
    """(names of std, patterns of OTHERS) in a file, outside of comments and texts."""
    code = NOT_CODE.sub("", file.read_text())
    return frozenset(USED.findall(code)), frozenset(p for p in OTHERS if re.search(p, code))


class Files:
    def __init__(self, root):
        self.root = root

    def find_own(self, file, name):
        """The file of ours that a quoted include means, or None."""
        top = file.relative_to(self.root).parts[:2]
        for folder in (file.parent, self.root / "src", self.root / "include", self.root / "apps",
                       self.root / "tests", self.root.joinpath(*top)):
            if (folder / name).is_file():
                return folder / name
        return None

    @functools.lru_cache(maxsize=None)
    def read_includes(self, file):
        """(standard headers, files of ours) that a file includes itself."""
        standard, own = set(), set()
        for bracket, name in INCLUDE.findall(file.read_text()):
            found = self.find_own(file, name) if bracket == '"' else None
            if found:
                own.add(found)
            elif bracket == "<":
                standard.update([name, *BRINGS.get(name, [])])
        return standard, own

    def find_included(self, file):
        """(standard headers, files of ours) that a file includes, itself or through others of ours."""
        seen, left, standard = set(), [file], set()
        while left:
            place = left.pop()
            if place in seen:
                continue
            seen.add(place)
            more, own = self.read_includes(place)
            standard |= more
            left += own
        return standard, seen


def main():
    root = pathlib.Path(sys.argv[1])
    headers, files = find_headers(), Files(root)
    faults, use_count = [], 0
    for file in list_code(root):
        if is_part(file):
            continue
        included, reached = files.find_included(file)
        place = file.relative_to(root)
        used = [find_used(f) for f in [file, *filter(is_part, reached)]]
        for pattern in sorted(set().union(*(patterns for _, patterns in used))):
            if not OTHERS[pattern] & included:
                faults.append(describe(place, f"what {pattern} finds", OTHERS[pattern]))
        for name in sorted(set().union(*(names for names, _ in used)) - ANYWHERE):
            use_count += 1
            if name not in headers:
                faults.append(f"{place}: tests/layout/check_standard.py does not know std::{name}")
            elif not headers[name] & included:
                faults.append(describe(place, f"std::{name}", headers[name]))
    if use_count == 0:
        faults.append("no names of std found: is the root right?")
    finish(faults)


main()
