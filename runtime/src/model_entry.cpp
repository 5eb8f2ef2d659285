#include "model_entry.hpp"

#include <set>
#include <stdexcept>

#include "sha256.hpp"
#include "trusted_file.hpp"

namespace idim {

namespace {

constexpr const char* library_name = "model.so";
constexpr const char* record_name = "model.sha256";
constexpr const char* exports_name = "model.exports";

// Everything else is hidden: the names in a generated header are inline variables, which g++ makes one per process
// (STB_GNU_UNIQUE) even under RTLD_LOCAL, so that a second model of the same robot would read those of the first.
// -Bsymbolic does not bind such symbols, and clang has no -fno-gnu-unique.
constexpr const char* exports = "{ global: idim_model; idim_effects; idim_law; local: *; };\n";

bool is_inside(const std::string& name) {
    const std::filesystem::path path(name);
    const bool plain = path.lexically_normal().string() == name && name != "." && name.find('\0') == std::string::npos;
    return plain && path.is_relative() && path.has_filename() && *path.begin() != "..";
}

bool is_compiled(const model_source& source) {
    return std::filesystem::path(source.name).extension() == ".cpp";
}

/// The folders between the entry and the file are checked with it.
std::string read_source(const std::filesystem::path& entry, const std::string& name) {
    std::filesystem::path path = entry;
    for (const std::filesystem::path& part : std::filesystem::path(name).parent_path()) {
        path /= part;
        require_trusted_folder(path);
    }
    return read_trusted_file(entry / name);
}

std::string with_length(const std::string& text) {
    return std::to_string(text.size()) + ":" + text;
}

}  // namespace

void require_source_names(const std::vector<model_source>& sources) {
    std::set<std::string> taken = {library_name, record_name, exports_name};
    bool compiled = false;
    for (const model_source& source : sources) {
        if (!is_inside(source.name)) {
            throw std::logic_error("model source '" + source.name + "' is not a plain path inside the model's folder");
        }
        if (!taken.insert(source.name).second) {
            throw std::logic_error("model source '" + source.name + "': the name is taken");
        }
        compiled = compiled || is_compiled(source);
    }
    if (!compiled) {
        throw std::logic_error("no .cpp file among the model's sources");
    }
}

std::string entry_key(const std::vector<model_source>& sources, const system_compiler& compiler) {
    std::string text =
        with_length(std::to_string(IDIM_MODEL_ABI)) + with_length(compiler.version) + with_length(exports);
    text += with_length(std::to_string(compiler.command.size()));
    for (const std::string& word : compiler.command) {
        text += with_length(word);
    }
    for (const model_source& source : sources) {
        text += with_length(source.name) + with_length(source.text);
    }
    return sha256(text);
}

void build_entry(const std::filesystem::path& entry, const std::vector<model_source>& sources,
                 const system_compiler& compiler) {
    library_files files{entry, {}, entry / exports_name, entry / library_name};
    write_private_file(files.exports, exports);
    for (const model_source& source : sources) {
        write_private_file(entry / source.name, source.text);
        if (is_compiled(source)) {
            files.sources.push_back(entry / source.name);
        }
    }
    compile_library(compiler, files);
    make_file_private(files.library);
    write_private_file(entry / record_name, sha256(read_trusted_file(files.library)) + "\n");
}

std::string read_entry(const std::filesystem::path& entry, const std::vector<model_source>& sources) {
    require_trusted_folder(entry);
    for (const model_source& source : sources) {
        if (read_source(entry, source.name) != source.text) {
            throw std::runtime_error((entry / source.name).string() + " is not the model's source");
        }
    }
    std::string library = read_trusted_file(entry / library_name);
    if (read_trusted_file(entry / record_name) != sha256(library) + "\n") {
        throw std::runtime_error((entry / library_name).string() + " has not the recorded hash");
    }
    return library;
}

}  // namespace idim
