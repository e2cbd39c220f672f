// Bytes of an FBX file must end in records that are written as a file with the same records, or in an Error.
// The importer that takes this file is not run.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "io/mesh/fbx_facts.h"
#include "relief/error.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        std::optional<relief::FbxDocument> document =
            relief::FbxDocument::parse({reinterpret_cast<const char*>(data), size});
        if (!document) return 0;
        relief::prepare_fbx(*document);
        const std::string bytes = document->write();
        if (!relief::FbxDocument::parse(bytes)) std::abort();
    } catch (const relief::Error&) {
        // refused with a message: what is wanted
    }
    return 0;
}
