"""Writes a C++ source with the words of SPIR-V files and a function that finds them by name.

embed_shaders.py OUTPUT HEADER NAMESPACE SPIRV_FILE...
"""
import pathlib
import sys

output, header, namespace, *files = sys.argv[1:]
arrays, cases = [], []
for file in map(pathlib.Path, files):
    data = file.read_bytes()
    words = [str(int.from_bytes(data[i:i + 4], "little")) + "u" for i in range(0, len(data), 4)]
    arrays.append(f"constexpr uint32_t {file.stem}_words[] = {{{', '.join(words)}}};\n")
    cases.append(f'    if (name == "{file.stem}") return {file.stem}_words;\n')

pathlib.Path(output).write_text(
    f'// Written by {pathlib.Path(__file__).name}.\n#include "{header}"\n\nnamespace {namespace} {{\n'
    f"namespace {{\n{''.join(arrays)}}} // namespace\n\n"
    "std::span<const uint32_t> find_shader([[maybe_unused]] std::string_view name) {\n"
    f"{''.join(cases)}    return {{}};\n}}\n\n}} // namespace {namespace}\n")
