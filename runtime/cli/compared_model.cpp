#include "compared_model.hpp"

#include <filesystem>

#include "emit/manifest_file.hpp"
#include "emit/model_folder.hpp"
#include "generator.hpp"
#include "idim/input_error.hpp"
#include "measured_motion.hpp"
#include "resources.hpp"

namespace idim::cli {

namespace {

using generator::model_folder;
using generator::rendered_file;

compared_model compile(const std::string& path, const model_folder& model) {
    compiled_model compiled = compile_files(model.files, model.content.input_hash);
    generator::model_summary summary = generator::summarise(model.content, compiled.interface(), path);
    return {path, std::move(summary), std::move(compiled)};
}

compared_model load_folder(const std::string& path) {
    const model_folder model = generator::read_model(path);
    if (model.content.target != "cpp") {
        throw input_error({path, 0, "target"}, "code of " + model.content.target + ", expected that of cpp");
    }
    try {
        return compile(path, model);
    } catch (const input_error&) {
        throw;
    } catch (const std::exception& error) {  // of the compiler, the loader, or names that are no source's
        throw input_error({path, 0, ""}, std::string("the code in this folder cannot be used: ") + error.what());
    }
}

compared_model load_description(const std::string& path) {
    generator::generated_model generated = generator::generate(path, templates_folder());
    model_folder model;
    for (rendered_file& file : generated.files) {
        if (file.name == generator::manifest_name) {
            model.content = generator::read_manifest(file.text, path);
        } else {
            model.files.push_back(std::move(file));
        }
    }
    return compile(path, model);
}

}  // namespace

compared_model load_compared(const std::string& path) {
    return std::filesystem::is_directory(path) ? load_folder(path) : load_description(path);
}

}  // namespace idim::cli
