#include "idim/compiled_model.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "loaded_library.hpp"
#include "model_cache.hpp"
#include "model_entry.hpp"
#include "system_compiler.hpp"

namespace idim {

namespace {

/// What one call asks for.
struct compile_request {
    const std::vector<model_source>& sources;
    const std::string& input_hash;
    system_compiler compiler;
};

/// Throws std::runtime_error saying what is wrong with the model.
compiled_model load_model(const std::string& bytes, const std::string& input_hash) {
    std::shared_ptr<void> library = load_library(bytes);
    const auto handshake = reinterpret_cast<decltype(&idim_model)>(dlsym(library.get(), "idim_model"));
    if (handshake == nullptr) {
        throw std::runtime_error("it has no function idim_model");
    }
    const idim_model_interface* const model = handshake();
    if (model == nullptr) {
        throw std::runtime_error("idim_model() gives no model");
    }
    if (model->abi != IDIM_MODEL_ABI) {
        throw std::runtime_error(fmt::format("its interface is version {}, not {}", model->abi, IDIM_MODEL_ABI));
    }
    if (model->input_hash == nullptr || model->input_hash != input_hash) {
        throw std::runtime_error(fmt::format("its input hash is '{}', not '{}'",
                                             model->input_hash == nullptr ? "" : model->input_hash, input_hash));
    }
    return compiled_model(std::move(library), model);
}

compiled_model open_entry(const cache_slot& slot, const compile_request& request) {
    return load_model(read_entry(slot.entry(), request.sources), request.input_hash);
}

compiled_model compile_in(const std::filesystem::path& cache, const compile_request& request) {
    const cache_slot slot(cache, entry_key(request.sources, request.compiler));
    try {
        return open_entry(slot, request);
    } catch (const std::runtime_error&) {
        slot.replace(
            [&](const std::filesystem::path& folder) { build_entry(folder, request.sources, request.compiler); });
    }
    try {
        return open_entry(slot, request);
    } catch (const std::runtime_error& error) {
        slot.clear();
        throw std::runtime_error(std::string("the compiled model cannot be used: ") + error.what());
    }
}

}  // namespace

compiled_model compile_model(const std::vector<model_source>& sources, const std::string& input_hash,
                             const compile_options& options) {
    require_source_names(sources);
    const compile_request request{sources, input_hash, find_compiler(options.compiler)};
    if (const std::optional<std::filesystem::path> cache = usable_cache(options.cache)) {
        try {
            return compile_in(*cache, request);
        } catch (const std::system_error&) {
            // A full disk, or an entry of another user: as good as no cache.
        }
    }
    const private_folder folder(std::filesystem::temp_directory_path() / "idim-");
    return compile_in(folder.path(), request);
}

}  // namespace idim
