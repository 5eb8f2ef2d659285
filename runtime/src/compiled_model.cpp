#include "idim/compiled_model.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "idim/private_folder.hpp"
#include "loaded_library.hpp"
#include "model_cache.hpp"
#include "model_entry.hpp"
#include "system_compiler.hpp"

namespace idim {

namespace {

/// What one call asks for.
struct compile_request {
    const std::vector<model_source>& sources;
    system_compiler compiler;
};

/// The table that a loaded library gives through its one function. Throws std::runtime_error where it has none.
template <class Table>
const Table* handshake_of(const std::shared_ptr<void>& library, const char* function) {
    using getter = const Table* (*)();
    const auto get = reinterpret_cast<getter>(dlsym(library.get(), function));
    if (get == nullptr) {
        throw std::runtime_error(fmt::format("it has no function {}", function));
    }
    const Table* const table = get();
    if (table == nullptr) {
        throw std::runtime_error(fmt::format("{}() gives nothing", function));
    }
    return table;
}

void check_abi(int found, int expected) {
    if (found != expected) {
        throw std::runtime_error(fmt::format("its interface is version {}, not {}", found, expected));
    }
}

/// Throws std::runtime_error saying what is wrong with the model.
compiled_model load_model(const std::string& bytes, const std::string& input_hash) {
    std::shared_ptr<void> library = load_library(bytes);
    const auto* const model = handshake_of<idim_model_interface>(library, "idim_model");
    check_abi(model->abi, IDIM_MODEL_ABI);
    if (model->input_hash == nullptr || model->input_hash != input_hash) {
        throw std::runtime_error(fmt::format("its input hash is '{}', not '{}'",
                                             model->input_hash == nullptr ? "" : model->input_hash, input_hash));
    }
    return compiled_model(std::move(library), model);
}

/// Gives a loader of the table that `function` hands out.
template <class Table>
auto table_loader(const char* function, int abi) {
    return [function, abi](const std::string& bytes) {
        std::shared_ptr<void> library = load_library(bytes);
        const auto* const table = handshake_of<Table>(library, function);
        check_abi(table->abi, abi);
        return compiled_table<Table>(std::move(library), table);
    };
}

template <class Load>
auto compile_in(const std::filesystem::path& cache, const compile_request& request, const Load& load) {
    const cache_slot slot(cache, entry_key(request.sources, request.compiler));
    const auto open = [&] { return load(read_entry(slot.entry(), request.sources)); };
    try {
        return open();
    } catch (const std::runtime_error&) {
        slot.replace(
            [&](const std::filesystem::path& folder) { build_entry(folder, request.sources, request.compiler); });
    }
    try {
        return open();
    } catch (const std::runtime_error& error) {
        slot.clear();
        throw std::runtime_error(std::string("the compiled model cannot be used: ") + error.what());
    }
}

template <class Load>
auto compile_sources(const std::vector<model_source>& sources, const compile_options& options, const Load& load) {
    require_source_names(sources);
    const compile_request request{sources, find_compiler(options.compiler)};
    if (const std::optional<std::filesystem::path> cache = usable_cache(options.cache)) {
        try {
            return compile_in(*cache, request, load);
        } catch (const std::system_error&) {
            // A full disk, or an entry of another user: as good as no cache.
        }
    }
    const private_folder folder(std::filesystem::temp_directory_path() / "idim-");
    return compile_in(folder.path(), request, load);
}

}  // namespace

compiled_model compile_model(const std::vector<model_source>& sources, const std::string& input_hash,
                             const compile_options& options) {
    return compile_sources(sources, options, [&](const std::string& bytes) { return load_model(bytes, input_hash); });
}

compiled_effects compile_effects(const std::vector<model_source>& sources, const compile_options& options) {
    return compile_sources(sources, options, table_loader<idim_effect_table>("idim_effects", IDIM_EFFECT_ABI));
}

compiled_law compile_law(const std::vector<model_source>& sources, const compile_options& options) {
    return compile_sources(sources, options, table_loader<idim_law_table>("idim_law", IDIM_LAW_ABI));
}

}  // namespace idim
